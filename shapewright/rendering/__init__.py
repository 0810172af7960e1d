"""Images of meshes with ModernGL on EGL; the only package that imports moderngl."""
