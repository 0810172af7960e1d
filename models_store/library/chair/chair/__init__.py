"""The procedural model ``chair``: see build.py."""
