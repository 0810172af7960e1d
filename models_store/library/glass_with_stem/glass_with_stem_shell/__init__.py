"""The procedural model ``glass_with_stem_shell``: see build.py."""
