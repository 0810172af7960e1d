"""The procedural model ``bicycle_step_through``: see build.py."""
