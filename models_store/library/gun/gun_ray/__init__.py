"""The procedural model ``gun_ray``: see build.py."""
