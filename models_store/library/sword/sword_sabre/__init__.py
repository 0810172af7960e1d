"""The procedural model ``sword_sabre``: see build.py."""
