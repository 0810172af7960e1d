"""The procedural model ``sword_katana``: see build.py."""
