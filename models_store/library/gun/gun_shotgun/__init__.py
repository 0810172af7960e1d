"""The procedural model ``gun_shotgun``: see build.py."""
