"""The procedural model ``animal``: see build.py."""
