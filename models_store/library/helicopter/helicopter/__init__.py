"""The procedural model ``helicopter``: see build.py."""
