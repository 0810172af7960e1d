"""The procedural model ``fish_shark``: see build.py."""
