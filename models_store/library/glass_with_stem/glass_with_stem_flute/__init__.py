"""The procedural model ``glass_with_stem_flute``: see build.py."""
