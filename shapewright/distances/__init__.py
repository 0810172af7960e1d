"""Distances between meshes: panorama, surface, z-buffer."""
