"""The procedural model ``spider_earwig``: see build.py."""
