"""The procedural model ``helicopter_blocky``: see build.py."""
