"""The procedural model ``fish``: see build.py."""
