"""What the scripts of the library share: writing a model and its picture to its folder."""

from pathlib import Path

from models_store.library.shipped import DOCUMENT, THUMBNAIL
from shapewright.modeling import ProceduralModel, compile_model

THUMBNAIL_SIZE = 256


def publish(model: ProceduralModel, folder: Path) -> None:
    """Write ``model.json`` and ``thumbnail.png``.

    Raises:
        RenderingError: no headless OpenGL; the document is written all the same.
    """
    model.save(folder / DOCUMENT)
    from PIL import Image

    from shapewright.rendering import render_mesh, three_quarter_view

    compiled = compile_model(model)
    picture = render_mesh(
        compiled.instance(compiled.base_values()), rotation=three_quarter_view("z"), size=THUMBNAIL_SIZE
    )
    Image.fromarray(picture).save(folder / THUMBNAIL, optimize=True)
