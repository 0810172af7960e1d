"""What workers keep as artefacts and find again: banks, classifiers, indexes, arrays."""
