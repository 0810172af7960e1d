"""The procedural model ``helicopter_attack``: see build.py."""
