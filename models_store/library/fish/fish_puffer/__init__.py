"""The procedural model ``fish_puffer``: see build.py."""
