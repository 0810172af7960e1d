"""The procedural model ``spider_beetle``: see build.py."""
