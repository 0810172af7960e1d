"""Draws lists of objects into a column of tiles and reads all pictures back at once. Knows OpenGL, not meshes."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import moderngl
import numpy as np
from jaxtyping import Float, Float32, Int, UInt8

from shapewright.errors import RenderingError
from shapewright.rendering.styles import WINDOW, Style

SAMPLE_BYTES = 8
"""Packed surface (4) and depth (4) that one sample of the atlas takes."""
MAX_ATLAS_BYTES = 64 * 2**20
"""Bound of the atlas' memory; larger batches are drawn piece by piece."""
STEP_HEIGHT = 0.05
"""A jump in depth of this size, in the same units, is drawn as an edge."""


@dataclass(frozen=True, eq=False)
class Scene:
    """One batch: objects side by side in shared arrays, and which of them each picture shows.

    Args:
        positions: vertices of all objects, normalised.
        triangles: corners of all objects, counted from each object's first vertex.
        commands: one row a draw: corners, pictures, first corner, first vertex, first picture (OpenGL's
            ``DrawElementsIndirectCommand``).
        placements: one row a picture: rows of (scale * rotation | translation).
        rectangles: what each picture's object covers at most: left, bottom, right, top after placing.
        tints: colour number of each picture's object, from 1.
        normals: of each vertex where smooth shading is wanted.
        colors: red, green, blue in 0..1 of each vertex, for ``shaded``; they replace the color of the number.
    """

    positions: Float32[np.ndarray, "V 3"]
    triangles: Int[np.ndarray, "F 3"]
    commands: Int[np.ndarray, "D 5"]
    placements: Float[np.ndarray, "N 3 4"]
    rectangles: Float[np.ndarray, "N 4"]
    tints: Int[np.ndarray, " N"]
    normals: Float32[np.ndarray, "V 3"] | None = None
    colors: Float32[np.ndarray, "V 3"] | None = None


@dataclass
class _Target:
    """Textures of an atlas; kept from batch to batch."""

    surface: Any
    depth: Any
    picture: Any
    surface_frame: Any
    picture_frame: Any
    tiles: int
    colors: Any = None

    def release(self) -> None:
        for part in (self.surface_frame, self.picture_frame, self.surface, self.depth, self.picture, self.colors):
            if part is not None:
                part.release()


@dataclass
class Renderer:
    """Programs and targets that live as long as their context. Use only while the context is current."""

    context: Any
    _programs: dict[tuple[str, ...], Any] = field(default_factory=dict)
    _target_key: tuple[int, int, bool] | None = None
    _target: _Target | None = None

    def tiles_a_batch(self, size: int, style: Style) -> int:
        """How many pictures fit one atlas, by the driver's texture limit and :data:`MAX_ATLAS_BYTES`.

        Raises:
            RenderingError: not even one picture of this size fits.
        """
        side = size * style.oversampling
        limit = int(self.context.info["GL_MAX_TEXTURE_SIZE"])
        if side > limit:
            raise RenderingError(
                f"a picture of {size} pixels needs {side} samples a side, the driver allows {limit}", where="size"
            )
        return max(1, min(limit // side, MAX_ATLAS_BYTES // (side * side * SAMPLE_BYTES)))

    def draw(self, scene: Scene, out: UInt8[np.ndarray, "N H W 3"], style: Style, *, window: float = WINDOW) -> None:
        """Draw one batch and read it back into ``out``, whose rows run from top to bottom."""
        size = out.shape[1]
        side = size * style.oversampling
        target = self._target_for(size, style.oversampling, len(out), colored=scene.colors is not None)
        self._draw_surface(scene, target, side, window)
        colored = ("COLORED",) if scene.colors is not None else ()
        program = self._program("picture.vert", "edges_common", f"{style.shader}.frag", *colored)
        spacing = 2.0 * window / (min(style.oversampling, 2) * size)
        self._set(
            program,
            surface=0,
            surface_colors=1,
            picture_size=size,
            oversampling=style.oversampling,
            sample_spacing=spacing,
            step_height=STEP_HEIGHT,
            line_strength=style.line_strength,
            background=style.background,
            colors=style.colors,
            window=window,
            tile_count=float(len(out)),
        )
        target.picture_frame.use()
        target.picture_frame.viewport = viewport = (0, 0, size, size * len(out))
        target.picture_frame.clear(*style.background, viewport=viewport)
        self.context.enable_only(moderngl.NOTHING)
        target.surface.use(0)
        if target.colors is not None:
            target.colors.use(1)
        with ExitStack() as stack:
            rectangles = self.context.buffer(scene.rectangles.astype(np.float32))
            stack.callback(rectangles.release)
            shown = self.context.vertex_array(program, [(rectangles, "4f/i", "in_rectangle")])
            stack.callback(shown.release)
            shown.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(out))
        target.picture_frame.read_into(out, viewport=viewport, components=3, alignment=1)

    def _draw_surface(self, scene: Scene, target: _Target, side: int, window: float) -> None:
        smooth = ("SMOOTH",) if scene.normals is not None else ()
        colored = ("COLORED",) if scene.colors is not None else ()
        program = self._program("geometry.vert", "geometry.frag", *smooth, *colored)
        self._set(
            program,
            window=window,
            tile_count=float(len(scene.placements)),
            samples_per_unit=side / (2.0 * window),
        )
        target.surface_frame.use()
        target.surface_frame.viewport = viewport = (0, 0, side, side * len(scene.placements))
        target.surface_frame.clear(0.0, 0.0, 0.0, 0.0, depth=1.0, viewport=viewport)
        self.context.enable_only(moderngl.DEPTH_TEST)
        self.context.enable_direct(0x3000)  # GL_CLIP_DISTANCE0
        self.context.enable_direct(0x3001)
        per_picture = np.empty((len(scene.placements), 14), dtype=np.float32)
        per_picture[:, :12] = scene.placements.reshape(-1, 12)
        per_picture[:, 12] = np.arange(len(scene.placements))
        per_picture[:, 13] = scene.tints
        with ExitStack() as stack:

            def buffer(array: np.ndarray) -> Any:
                made = self.context.buffer(np.ascontiguousarray(array))
                stack.callback(made.release)
                return made

            content = [
                (buffer(scene.positions), "3f", "in_position"),
                (buffer(per_picture), "4f 4f 4f 2f/i", "in_row_x", "in_row_y", "in_row_z", "in_tile_tint"),
            ]
            if scene.normals is not None:
                content.append((buffer(scene.normals), "3f", "in_normal"))
            if scene.colors is not None:
                content.append((buffer(scene.colors), "3f", "in_color"))
            corners = buffer(scene.triangles.astype(np.uint32))
            vertex_array = self.context.vertex_array(program, content, index_buffer=corners)
            stack.callback(vertex_array.release)
            commands = buffer(scene.commands.astype(np.uint32))
            vertex_array.render_indirect(commands, moderngl.TRIANGLES, count=len(scene.commands))
        self.context.disable_direct(0x3000)
        self.context.disable_direct(0x3001)

    def _program(self, vertex: str, *rest: str) -> Any:
        key = (vertex, *rest)
        if key not in self._programs:
            defines = "".join(f"#define {name}\n" for name in rest if name.isupper())
            parts = [part for part in rest if not part.isupper()]
            self._programs[key] = self.context.program(
                vertex_shader=_with_defines(_shader(vertex), defines),
                fragment_shader=_with_defines("".join(_shader(part) for part in parts), defines),
            )
        return self._programs[key]

    @staticmethod
    def _set(program: Any, **values: Any) -> None:
        for name, value in values.items():
            if name in program:
                program[name].value = value

    def _target_for(self, size: int, oversampling: int, tiles: int, *, colored: bool) -> _Target:
        key = (size, oversampling, colored)
        if self._target is not None and (self._target_key != key or self._target.tiles < tiles):
            self._target.release()
            self._target = None
        if self._target is None:
            side = size * oversampling
            surface = self.context.texture((side, side * tiles), 4)
            surface.filter = (moderngl.NEAREST, moderngl.NEAREST)
            colors = self.context.texture((side, side * tiles), 4) if colored else None
            depth = self.context.depth_renderbuffer((side, side * tiles))
            picture = self.context.renderbuffer((size, size * tiles), 3)
            self._target = _Target(
                surface=surface,
                depth=depth,
                picture=picture,
                surface_frame=self.context.framebuffer([surface] if colors is None else [surface, colors], depth),
                picture_frame=self.context.framebuffer([picture]),
                tiles=tiles,
                colors=colors,
            )
            self._target_key = key
        return self._target


def renderer_for(context: Any) -> Renderer:
    """The renderer of a context, made when first asked for and kept with it."""
    if context.extra is None:
        context.extra = Renderer(context)
    renderer: Renderer = context.extra
    return renderer


def indirect_commands(
    objects: Int[np.ndarray, " N"],
    first_corner: Sequence[int] | Int[np.ndarray, " M"],
    corner_count: Sequence[int] | Int[np.ndarray, " M"],
    first_vertex: Sequence[int] | Int[np.ndarray, " M"],
) -> Int[np.ndarray, "D 5"]:
    """Draws for a list of pictures: neighbours that show the same object share one draw."""
    starts = np.flatnonzero(np.diff(objects, prepend=-1))
    shown = objects[starts]
    return np.stack(
        [
            np.asarray(corner_count)[shown],
            np.diff(starts, append=len(objects)),
            np.asarray(first_corner)[shown],
            np.asarray(first_vertex)[shown],
            starts,
        ],
        axis=1,
    )


def _shader(name: str) -> str:
    return resources.files(__package__).joinpath("shaders", f"{name}.glsl").read_text(encoding="utf-8")


def _with_defines(source: str, defines: str) -> str:
    version, _, body = source.partition("\n")
    return f"{version}\n{defines}{body}"
