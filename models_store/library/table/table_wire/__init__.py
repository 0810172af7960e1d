"""The procedural model ``table_wire``: see build.py."""
