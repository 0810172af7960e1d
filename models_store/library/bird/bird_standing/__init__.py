"""The procedural model ``bird_standing``: see build.py."""
