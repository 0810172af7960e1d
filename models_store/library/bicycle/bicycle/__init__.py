"""The procedural model ``bicycle``: see build.py."""
