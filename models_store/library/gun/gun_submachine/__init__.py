"""The procedural model ``gun_submachine``: see build.py."""
