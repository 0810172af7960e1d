"""The procedural model ``helicopter_bubble``: see build.py."""
