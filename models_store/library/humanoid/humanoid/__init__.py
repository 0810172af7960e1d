"""The procedural model ``humanoid``: see build.py."""
