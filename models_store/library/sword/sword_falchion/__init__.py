"""The procedural model ``sword_falchion``: see build.py."""
