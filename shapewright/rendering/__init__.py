"""Images of meshes with ModernGL on EGL; the only package that imports moderngl.

Importing it opens nothing: the context of a process is made when something is drawn first.
"""

from shapewright.rendering.context import context_is_open, renderer_name, shared_context
from shapewright.rendering.images import STYLES, ImageStyle, render_images
from shapewright.rendering.pictures import compose_side_by_side, render_mesh
from shapewright.rendering.renderer import WINDOW
from shapewright.rendering.views import SCALE_RANGE, even_views, random_views, three_quarter_view

__all__ = [
    "SCALE_RANGE",
    "STYLES",
    "WINDOW",
    "ImageStyle",
    "compose_side_by_side",
    "context_is_open",
    "even_views",
    "random_views",
    "render_images",
    "render_mesh",
    "renderer_name",
    "shared_context",
    "three_quarter_view",
]
