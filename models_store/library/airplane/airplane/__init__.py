"""The procedural model ``airplane``: see build.py."""
