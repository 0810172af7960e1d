"""The procedural model ``glass_with_stem_round``: see build.py."""
