"""The procedural model ``gun_machine``: see build.py."""
