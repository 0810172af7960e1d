"""The procedural model ``sword_rapier``: see build.py."""
