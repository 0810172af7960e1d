"""The procedural model ``sword_winged``: see build.py."""
