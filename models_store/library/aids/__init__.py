"""What scripts of several models share: round parts, bodies of cross-sections, boards, rods, and parts of a class.

Everything here only calls the recorder; a document knows nothing of it.
"""
