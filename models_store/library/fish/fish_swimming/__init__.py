"""The procedural model ``fish_swimming``: see build.py."""
