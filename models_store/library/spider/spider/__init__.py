"""The procedural model ``spider``: see build.py."""
