"""One context a process: nothing at import, safe with threads and forks, a clear word when OpenGL is missing."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import simple_shapes

from shapewright.errors import RenderingError
from shapewright.rendering import context, render_mesh

DRAW = """
import numpy as np
from shapewright.mesh import TriangleMesh
from shapewright.rendering import render_mesh, context_is_open
def draw():
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    return render_mesh(mesh, size=32)
"""


def run(script: str) -> str:
    """Run a script in a fresh interpreter; a hang is a failure."""
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_importing_opens_nothing():
    script = """
import sys
import shapewright.rendering as rendering
assert "moderngl" not in sys.modules
rendering.render_images, rendering.render_mesh
assert not rendering.context_is_open()
print("fine")
"""
    assert run(script).strip() == "fine"


def test_a_forked_child_draws_with_a_context_of_its_own():
    script = (
        DRAW
        + """
import os
for _ in range(2):
    assert not context_is_open()
    child = os.fork()
    if child == 0:
        ok = draw().shape == (32, 32, 3) and context_is_open()
        os._exit(0 if ok else 1)
    assert os.waitpid(child, 0)[1] == 0
assert not context_is_open()
print(draw().shape)
"""
    )
    assert run(script).strip() == "(32, 32, 3)"


def test_a_fork_after_drawing_is_refused_and_does_not_hang():
    script = (
        DRAW
        + """
import os
from shapewright.errors import RenderingError
draw()
child = os.fork()
if child == 0:
    try:
        draw()
    except RenderingError as error:
        os._exit(0 if "forked" in str(error) else 1)
    os._exit(2)
assert os.waitpid(child, 0)[1] == 0
draw()
print("parent goes on")
"""
    )
    assert run(script).strip() == "parent goes on"


def test_threads_take_turns():
    mesh = simple_shapes.stool()
    here = render_mesh(mesh, size=64)
    with ThreadPoolExecutor(4) as pool:
        for there in pool.map(lambda _: render_mesh(mesh, size=64), range(12)):
            assert np.array_equal(here, there)


def test_missing_libraries_are_named(monkeypatch):
    monkeypatch.setattr(context, "_holder", context._Holder())
    monkeypatch.setattr(context, "_BACKEND", {**context._BACKEND, "libegl": "libnot-there.so.1"})
    with pytest.raises(RenderingError, match="apt-get install libegl1 libegl-mesa0 libgl1"):
        render_mesh(simple_shapes.box(), size=32)
    assert not context.context_is_open()
