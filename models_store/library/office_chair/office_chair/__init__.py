"""The procedural model ``office_chair``: see build.py."""
