"""The procedural model ``gun_rifle``: see build.py."""
