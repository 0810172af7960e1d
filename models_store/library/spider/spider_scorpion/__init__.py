"""The procedural model ``spider_scorpion``: see build.py."""
