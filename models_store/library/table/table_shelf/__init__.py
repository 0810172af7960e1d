"""The procedural model ``table_shelf``: see build.py."""
