"""The procedural models that ship: one folder a model with its document, the script that models it, a thumbnail."""
