"""The procedural model ``fish_disc``: see build.py."""
