"""The procedural model ``stool``: see build.py."""
