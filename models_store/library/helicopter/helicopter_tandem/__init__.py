"""The procedural model ``helicopter_tandem``: see build.py."""
