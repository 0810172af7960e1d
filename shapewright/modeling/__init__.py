"""Procedural models: a base mesh, an ordered list of modelling operations, and named parameters."""
