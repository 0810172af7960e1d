"""The procedural model ``spider_segmented``: see build.py."""
