"""The procedural model ``glass_with_stem_goblet``: see build.py."""
