"""Estimations of many meshes as one table: a row for each mesh, a column for each parameter by name."""
