"""The procedural model ``table_trestle``: see build.py."""
