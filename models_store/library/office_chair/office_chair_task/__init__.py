"""The procedural model ``office_chair_task``: see build.py."""
