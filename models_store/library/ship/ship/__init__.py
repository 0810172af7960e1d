"""The procedural model ``ship``: see build.py."""
