"""The procedural model ``spaceship``: see build.py."""
