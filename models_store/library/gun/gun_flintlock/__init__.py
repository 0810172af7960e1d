"""The procedural model ``gun_flintlock``: see build.py."""
