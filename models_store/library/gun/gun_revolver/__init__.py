"""The procedural model ``gun_revolver``: see build.py."""
