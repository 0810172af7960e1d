"""What workers keep as artefacts and find again: banks, classifiers with their models, indexes, arrays."""
