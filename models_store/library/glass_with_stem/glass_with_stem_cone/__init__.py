"""The procedural model ``glass_with_stem_cone``: see build.py."""
