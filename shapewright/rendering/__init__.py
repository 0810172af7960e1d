"""Images of meshes with ModernGL on EGL; the only package that imports moderngl.

Names are loaded when first used, and the context of a process is made when something is drawn first.
"""

from typing import TYPE_CHECKING

from shapewright.lazy_names import lazy_names

if TYPE_CHECKING:
    from shapewright.rendering.contact_sheet import compose_contact_sheet
    from shapewright.rendering.context import context_is_open, renderer_name, shared_context
    from shapewright.rendering.images import render_images
    from shapewright.rendering.mesh_sheet import LabelledMesh, compose_mesh_sheet
    from shapewright.rendering.pictures import compose_grid, compose_side_by_side, render_mesh
    from shapewright.rendering.residual_pictures import compose_residuals
    from shapewright.rendering.strip import Pair, compose_strip
    from shapewright.rendering.styles import SCALE_RANGE, STYLES, WINDOW, ImageStyle
    from shapewright.rendering.views import even_views, random_views, spread_views, three_quarter_view

_HOMES = {
    "SCALE_RANGE": "styles",
    "STYLES": "styles",
    "WINDOW": "styles",
    "ImageStyle": "styles",
    "LabelledMesh": "mesh_sheet",
    "Pair": "strip",
    "compose_contact_sheet": "contact_sheet",
    "compose_grid": "pictures",
    "compose_mesh_sheet": "mesh_sheet",
    "compose_residuals": "residual_pictures",
    "compose_side_by_side": "pictures",
    "compose_strip": "strip",
    "context_is_open": "context",
    "even_views": "views",
    "random_views": "views",
    "render_images": "images",
    "render_mesh": "pictures",
    "renderer_name": "context",
    "shared_context": "context",
    "spread_views": "views",
    "three_quarter_view": "views",
}

__all__ = [
    "SCALE_RANGE",
    "STYLES",
    "WINDOW",
    "ImageStyle",
    "LabelledMesh",
    "Pair",
    "compose_contact_sheet",
    "compose_grid",
    "compose_mesh_sheet",
    "compose_residuals",
    "compose_side_by_side",
    "compose_strip",
    "context_is_open",
    "even_views",
    "random_views",
    "render_images",
    "render_mesh",
    "renderer_name",
    "shared_context",
    "spread_views",
    "three_quarter_view",
]

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
