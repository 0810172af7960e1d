"""The procedural model ``fish_eel``: see build.py."""
