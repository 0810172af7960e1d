"""The procedural model ``sword_dagger``: see build.py."""
