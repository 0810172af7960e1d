"""The procedural model ``gun``: see build.py."""
