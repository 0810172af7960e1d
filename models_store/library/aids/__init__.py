"""Modelling aids that models of several classes use: round parts, bodies of cross-sections, boards, fins.

Everything here only calls the recorder; a document knows nothing of it.
"""
