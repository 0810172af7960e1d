"""The procedural model ``sword_greatsword``: see build.py."""
