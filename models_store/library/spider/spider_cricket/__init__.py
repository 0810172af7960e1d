"""The procedural model ``spider_cricket``: see build.py."""
