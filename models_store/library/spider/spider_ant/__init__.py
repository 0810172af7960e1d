"""The procedural model ``spider_ant``: see build.py."""
