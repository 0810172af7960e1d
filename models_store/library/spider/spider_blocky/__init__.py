"""The procedural model ``spider_blocky``: see build.py."""
