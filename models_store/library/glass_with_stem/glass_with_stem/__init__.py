"""The procedural model ``glass_with_stem``: see build.py."""
