"""The procedural model ``tower``: see build.py."""
