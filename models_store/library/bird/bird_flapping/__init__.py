"""The procedural model ``bird_flapping``: see build.py."""
