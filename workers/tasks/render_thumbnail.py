"""Draw the base instance of a model for people."""

from functools import partial
from io import BytesIO
from typing import Final

from models_store import catalog
from workers.context import JobContext, Outcome

SIZE: Final = 512
SUBDIVISION_STEPS: Final = 2


def render_thumbnail(context: JobContext) -> Outcome:
    """Render the model with all parameters at their base values and keep the picture as PNG."""
    from PIL import Image

    from shapewright.modeling import compile_model
    from shapewright.rendering import render_mesh, three_quarter_view

    model_id = str(context.claim.payload["model_id"])
    compiled = compile_model(context.load_model(model_id))
    context.progress.report(0.3, "drawing")
    mesh = compiled.instance(compiled.base_values(), steps=SUBDIVISION_STEPS)
    png = BytesIO()
    picture = render_mesh(mesh, rotation=three_quarter_view("z"), size=SIZE)  # models stand with z up
    Image.fromarray(picture).save(png, format="PNG", optimize=True)
    key = context.own_key(f"thumbnails/{model_id}", "png")
    context.artifacts.put(key, png.getvalue())
    return Outcome(partial(catalog.record_thumbnail, model_id=model_id, thumbnail_key=key), (key,))
