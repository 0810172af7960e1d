"""The procedural model ``bird_penguin``: see build.py."""
