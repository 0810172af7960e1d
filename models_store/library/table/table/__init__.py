"""The procedural model ``table``: see build.py."""
