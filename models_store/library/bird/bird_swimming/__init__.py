"""The procedural model ``bird_swimming``: see build.py."""
