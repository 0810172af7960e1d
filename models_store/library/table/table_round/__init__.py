"""The procedural model ``table_round``: see build.py."""
