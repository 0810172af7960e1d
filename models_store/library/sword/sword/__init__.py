"""The procedural model ``sword``: see build.py."""
