"""The procedural models that ship: a folder a class, in it a folder a model: its script, document and thumbnail."""
