"""The procedural model ``bird_wader``: see build.py."""
