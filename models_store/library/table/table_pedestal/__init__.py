"""The procedural model ``table_pedestal``: see build.py."""
