"""The procedural model ``bird``: see build.py."""
