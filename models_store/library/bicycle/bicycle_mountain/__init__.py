"""The procedural model ``bicycle_mountain``: see build.py."""
