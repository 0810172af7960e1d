"""The procedural model ``helicopter_transport``: see build.py."""
