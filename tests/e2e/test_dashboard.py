"""The dashboard in Chromium, over a real service and a real worker: what a person sees and does on the page."""

import json
import os
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from chair_model import armchair
from command_line import write_lamp_model
from PIL import Image
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright
from waiting import PATIENCE_S

from cli.client import Client, connected
from cli.local_service import local_service
from models_store.library.shipped import list_classes, list_shipped, load_shipped
from shapewright.classification import exemplars_file
from shapewright.classification.ready_files import READY_FILE
from shapewright.mesh import TriangleMesh
from shapewright.modeling import ProceduralModel, Recorder, compile_model
from shapewright.training import TrainingSettings, train_classifier

pytestmark = pytest.mark.browser

# WebGL is drawn by SwiftShader: the same pictures with and without a graphics card.
CHROMIUM_ARGUMENTS = [
    "--no-sandbox",
    "--disable-background-networking",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
]
PATIENCE_MS = 1000 * PATIENCE_S
expect.set_options(timeout=PATIENCE_MS)


@dataclass(frozen=True)
class Site:
    """A running service with four models, two of them chairs, and a classifier of lamps and crates."""

    url: str
    lamp_id: str
    armchair_id: str
    lamp: ProceduralModel


@pytest.fixture(scope="module")
def built_dashboard(repository: Path) -> None:
    """Skip, or fail in CI, where there is no page to look at."""
    if not (repository / "service" / "dashboard" / "dist" / "index.html").is_file():
        message = "the dashboard is not built: bash scripts/setup test"
        if os.environ.get("CI") == "true":
            pytest.fail(message)
        pytest.skip(message)


@pytest.fixture(scope="module")
def site(built_dashboard: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    folder = tmp_path_factory.mktemp("dashboard")
    lamp_file, crate_file = write_lamp_model(folder), _write_crate_model(folder)
    with (
        pytest.MonkeyPatch.context() as patch,
        _started(folder, patch, ADD_SHIPPED_ON_START="false") as url,
        connected(url, ready_within_s=PATIENCE_S) as client,
    ):
        lamp, _ = client.post_document("/v1/models", lamp_file.read_text())
        crate, _ = client.post_document("/v1/models", crate_file.read_text())
        chair, _ = client.post_document("/v1/models", armchair().to_json())
        client.post_document("/v1/models", _stool().to_json())
        _train(client, [lamp["id"], crate["id"]])
        yield Site(url, lamp["id"], chair["id"], ProceduralModel.load(lamp_file))


@pytest.fixture(scope="module")
def fresh_url(built_dashboard: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a service as it begins: what ships, but with a small ready classifier of two classes."""
    folder = tmp_path_factory.mktemp("fresh")
    glasses = list_classes()["glass_with_stem"][:2]  # two, so that one can be left out where thresholds are measured
    classes = {"glass_with_stem": [compile_model(load_shipped(name)) for name in glasses]}
    classes["sword"] = [compile_model(load_shipped("sword"))]
    settings = TrainingSettings(variations=12, images_per_variation=2, image_size=96, negatives=12, epochs=20)
    trained = train_classifier(classes, settings)
    onnx = folder / READY_FILE
    onnx.write_bytes(trained.onnx)
    assert trained.exemplars is not None
    trained.exemplars.save(exemplars_file(onnx))
    with (
        pytest.MonkeyPatch.context() as patch,
        _started(folder, patch, READY_CLASSIFIER_DIR=str(folder)) as url,
    ):
        yield url


@contextmanager
def _started(folder: Path, patch: pytest.MonkeyPatch, **settings: str) -> Iterator[str]:
    for name, value in settings.items():
        patch.setenv(f"SHAPEWRIGHT_{name}", value)
    with local_service(folder / "data", port=0, log=folder / "service.log") as document:
        patch.undo()
        yield document["url"]


def _write_crate_model(folder: Path) -> Path:
    recorder = Recorder("crate", "crate", description="a box of variable height")
    box = recorder.box(1.0, 1.0, 1.0)
    recorder.extrude(box.top, 0.5, length="height")
    recorder.parameter("height", "height", 0.2, 2.0, unit="cm", base_value=50.0)
    path = folder / "crate.json"
    recorder.build().save(path)
    return path


def _stool() -> ProceduralModel:
    recorder = Recorder("stool", "chair", description="a seat on a leg")
    seat = recorder.box(1.0, 1.0, 0.2)
    recorder.extrude(seat.bottom, 0.8, length="leg_length")
    recorder.parameter("leg_length", "Leg length", 0.5, 2.0)
    return recorder.build()


def _train(client: Client, model_ids: list[str]) -> None:
    """Train a classifier that is small but real."""
    settings = {"variations": 10, "images_per_variation": 2, "negatives": 10, "epochs": 20}
    accepted = client.post("/v1/classifiers", {"name": "test", "model_ids": model_ids, "settings": settings})
    client.follow(accepted["job"])


@pytest.fixture(scope="module")
def browser(chromium_path: Path) -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=chromium_path, args=CHROMIUM_ARGUMENTS)
        yield chromium
        chromium.close()


@pytest.fixture
def new_page(browser: Browser, site: Site) -> Iterator[Callable[..., Page]]:
    """A function that opens the dashboard; exceptions on the page fail the test."""
    contexts = []
    thrown: list[str] = []

    def open_page(
        route: str = "", *, width: int = 1280, height: int = 800, scheme: str = "light", url: str = site.url
    ) -> Page:
        context = browser.new_context(
            viewport={"width": width, "height": height},
            color_scheme=scheme,  # type: ignore[arg-type]
            reduced_motion="reduce",
            base_url=url,
        )
        context.set_default_timeout(PATIENCE_MS)
        contexts.append(context)
        page = context.new_page()
        page.on("pageerror", lambda error: thrown.append(str(error)))
        page.goto(f"/{route}")
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert thrown == []


@pytest.fixture
def lamp_file(site: Site, tmp_path: Path) -> Path:
    """A long, thin lamp, turned, enlarged and moved away."""
    compiled = compile_model(site.lamp)
    mesh: TriangleMesh = compiled.instance(compiled.values_from_mapping({"post_length": 1.6, "post_width": 0.7}))
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    path = tmp_path / "found lamp.off"
    mesh.transformed(turn, np.array([3.0, 1.0, 2.0]), 2.5).save(path)
    return path


def _drawn(page: Page, subject: str) -> Locator:
    """The canvas, once it shows that subject."""
    stage = page.get_by_test_id("stage-canvas")
    expect(stage).to_have_attribute("data-subject", re.compile(f"^{subject}"))
    expect(stage.locator("canvas")).to_be_visible()
    expect(page.locator(".stage-busy")).to_have_attribute("data-busy", "false")
    return stage


def _shot(stage: Locator, path: Path) -> np.ndarray:
    """What the view shows now, as (height, width, 3) integers; also kept as a file to look at."""
    stage.page.mouse.move(0, 0)  # what is hovered looks different
    stage.locator("canvas").screenshot(path=path)
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def _picture(stage: Locator, path: Path, wanted: Callable[[np.ndarray], bool] | None = None) -> np.ndarray:
    """What the view shows once it stands still and, if a condition is given, meets it."""
    deadline = time.monotonic() + PATIENCE_S
    before, now = None, _shot(stage, path)
    while before is None or _changed_share(before, now) > 0 or (wanted is not None and not wanted(now)):
        assert time.monotonic() < deadline, f"the view does not come to show what is expected: {path}"
        stage.page.wait_for_timeout(150)
        before, now = now, _shot(stage, path)
    return now


def _unlike(other: np.ndarray) -> Callable[[np.ndarray], bool]:
    return lambda picture: _changed_share(other, picture) > 0.01


def _like(other: np.ndarray) -> Callable[[np.ndarray], bool]:
    return lambda picture: _changed_share(other, picture) < 1e-4


def _changed_share(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.mean(np.abs(a - b).max(axis=2) > 12))


def test_the_page_opens_on_something_to_do(new_page: Callable[..., Page], fresh_url: str, tmp_path: Path) -> None:
    page = new_page(url=fresh_url)
    start = page.get_by_role("region", name="What is this mesh?")
    expect(start.get_by_role("button", name="Drop a mesh")).to_be_enabled()
    expect(start.get_by_role("heading", name="The classifier knows 2 classes")).to_be_visible()
    page.wait_for_function(
        "() => { const all = [...document.querySelectorAll('.start img')];"
        " return all.length === 2 && all.every((image) => image.naturalWidth > 0); }"
    )
    expect(page.get_by_role("region", name="Models").get_by_role("group")).to_have_count(len(list_classes()))
    expect(page.get_by_role("region", name="Models").locator(".model-card")).to_have_count(len(list_shipped()))
    page.screenshot(path=tmp_path / "start.png")

    # From the keyboard alone: skip what is beside it, pass the drop zone, and try the goblet.
    for key in ("Tab", "Enter", "Tab", "Tab", "Enter"):
        page.keyboard.press(key)
    answer = page.get_by_test_id("answer")
    expect(answer).to_contain_text("Glass with stem")  # as the class, or as the nearest one
    expect(page.get_by_test_id("probabilities").get_by_role("listitem")).to_have_count(2)
    expect(page.get_by_test_id("probabilities")).to_contain_text("Classifier “ready”")
    expect(page.get_by_role("heading", name="goblet.ply").first).to_be_visible()
    _drawn(page, "mesh ")
    page.screenshot(path=tmp_path / "answer.png")

    best_of = f"Any glass with stem: best of {len(list_classes()['glass_with_stem'])} (most probable)"
    expect(page.get_by_label("Model", exact=True).locator("option:checked")).to_have_text(best_of)
    with page.expect_request(lambda request: request.url.endswith("/v1/estimations")) as asked:
        page.get_by_role("button", name="Rebuild it").click()
    assert asked.value.post_data_json["class_name"] == "glass_with_stem"
    progress = page.get_by_role("progressbar", name="Estimating parameters")
    expect(progress.or_(page.get_by_test_id("estimation-result")).first).to_be_visible()


def test_the_threshold_moves_and_an_unknown_mesh_says_why(
    new_page: Callable[..., Page], fresh_url: str, tmp_path: Path
) -> None:
    stool = compile_model(_stool())
    path = tmp_path / "found stool.off"
    stool.instance(stool.base_values()).save(path)
    page = new_page(url=fresh_url)
    page.get_by_test_id("mesh-file").set_input_files(path)
    answer, neighbor = page.get_by_test_id("answer"), page.get_by_test_id("neighbor")
    expect(answer).to_be_visible()
    stage = _drawn(page, "mesh ")
    slider, threshold = page.get_by_role("slider", name="Unknown below"), page.get_by_test_id("threshold")

    # Everything is known: the mesh stands alone, until the variation is asked for.
    slider.press("Home")
    expect(answer).to_have_attribute("data-known", "true")
    expect(threshold).to_contain_text("Accepts about 100 % of the objects of a class and refuses about 0 %")
    expect(neighbor).to_contain_text("from the nearest variation")
    alone = _picture(stage, tmp_path / "alone.png")

    # Nothing is known: the answer says why, and the nearest variation stands beside the mesh.
    slider.press("End")
    expect(answer).to_have_attribute("data-known", "false")
    expect(answer).to_contain_text("Nearest class")
    expect(threshold).to_contain_text("Accepts about 0 % of the objects of a class and refuses about 100 %")
    expect(neighbor).to_contain_text(re.compile(r"The nearest variation of this class is at distance \d\.\d\d"))
    beside = _picture(stage, tmp_path / "beside.png", _unlike(alone))
    page.screenshot(path=tmp_path / "unknown.png")

    toggle = neighbor.get_by_role("button", name="Nearest variation")
    toggle.click()
    _picture(stage, tmp_path / "alone-again.png", _like(alone))
    page.get_by_role("button", name="Reset the threshold").click()
    expect(slider).to_have_value("0.5")
    toggle.click()
    _picture(stage, tmp_path / "beside-again.png", _like(beside))
    neighbor.get_by_role("link", name="Open its model").click()
    _drawn(page, "model ")


def test_the_start_page_says_what_is_wrong_with_a_file(
    new_page: Callable[..., Page], fresh_url: str, tmp_path: Path
) -> None:
    page = new_page(url=fresh_url)
    broken = tmp_path / "broken.off"
    broken.write_text("OFF\nthree four\n")
    _drop(page, broken)
    alert = page.get_by_role("region", name="What is this mesh?").get_by_role("alert")
    expect(alert).to_contain_text("broken.off")
    expect(alert).to_contain_text("line 2")
    page.screenshot(path=tmp_path / "refused.png")
    alert.get_by_role("button", name="Dismiss").click()
    expect(alert).to_have_count(0)

    page.route("**/goblet*.ply", lambda route: route.fulfill(status=404, body="gone"))
    page.get_by_role("button", name="Try the goblet").click()
    expect(alert).to_contain_text("404")


@pytest.mark.parametrize("width", [390, 1000, 1920])
def test_the_start_page_fits_its_window(
    new_page: Callable[..., Page], fresh_url: str, width: int, tmp_path: Path
) -> None:
    page = new_page(url=fresh_url, width=width, height=844)
    expect(page.get_by_role("heading", name="The classifier knows 2 classes")).to_be_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    drop = page.get_by_role("button", name="Drop a mesh").bounding_box()
    assert drop is not None
    assert drop["y"] + drop["height"] < 600, "it is seen without scrolling"
    page.screenshot(path=tmp_path / "start.png", full_page=True)


def test_a_slider_moves_the_mesh_and_nothing_else(new_page: Callable[..., Page], site: Site, tmp_path: Path) -> None:
    page = new_page()
    models = page.get_by_role("region", name="Models")
    expect(models.get_by_role("link")).to_have_count(4)
    expect(models.get_by_role("group", name="Class Chair").get_by_role("link")).to_have_count(2)
    expect(page.get_by_text("Service ready")).to_be_visible()
    models.get_by_role("link", name="Lamp").click()
    expect(models.get_by_role("link", name="Lamp")).to_have_attribute("aria-current", "true")

    stage = _drawn(page, f"model {site.lamp_id}")
    base = _picture(stage, tmp_path / "base.png")
    assert len(np.unique(base.reshape(-1, 3), axis=0)) > 200, "WebGL drew nothing"

    slider = page.get_by_role("slider", name="Length of the post")
    row = page.locator('[data-parameter="post_length"]')
    expect(row.get_by_role("status")).to_have_text("100 mm")
    with page.expect_response(lambda answer: answer.url.endswith("/instances")) as answer:
        slider.press("Home")
    assert json.loads(answer.value.headers["x-shapewright-values"])["post_length"] == 0.5
    expect(row.get_by_role("status")).to_have_text("50.0 mm")
    _picture(stage, tmp_path / "short.png", _unlike(base))

    # Back at the base every pixel is as before: neither the camera nor the light has moved.
    page.get_by_role("button", name="Reset", exact=True).click()
    expect(row.get_by_role("status")).to_have_text("100 mm")
    _picture(stage, tmp_path / "again.png", _like(base))

    with page.expect_response(lambda answer: answer.url.endswith("/instances")) as answer:
        page.get_by_role("button", name="Random variation").click()
    used = json.loads(answer.value.headers["x-shapewright-values"])["post_length"]
    shown = row.get_by_role("status")
    expect(shown).not_to_have_text("100 mm")
    assert float(shown.inner_text().removesuffix(" mm")) == pytest.approx(100 * used, rel=0.01)


def test_what_depends_on_other_values_follows_them(new_page: Callable[..., Page], site: Site, tmp_path: Path) -> None:
    page = new_page(f"#/models/{site.armchair_id}")
    stage = _drawn(page, f"model {site.armchair_id}")
    whole = _picture(stage, tmp_path / "whole.png")

    def row(name: str) -> Locator:
        return page.locator(f'[data-parameter="{name}"]')

    def sent_by(action: Callable[[], object]) -> dict[str, float]:
        with page.expect_response(lambda answer: answer.url.endswith("/instances")) as answer:
            action()
        assert answer.value.status == 200
        values: dict[str, float] = json.loads(answer.value.headers["x-shapewright-values"])
        return values

    arm_height = page.get_by_role("slider", name="Armrest height")
    assert sent_by(lambda: arm_height.press("End"))["arm_height"] == 2.0
    expect(row("arm_height").get_by_role("status")).to_have_text("0.400 m")
    toggle = page.get_by_role("switch", name="Armrests")
    assert sent_by(toggle.click)["armrests"] == 0.0
    expect(toggle).not_to_be_checked()
    expect(arm_height).to_be_disabled()
    expect(row("arm_height")).to_contain_text("Only with armrests")
    bare = _picture(stage, tmp_path / "bare.png", _unlike(whole))

    assert sent_by(lambda: page.get_by_label("Back", exact=True).select_option("no back"))["back"] == 3.0
    _picture(stage, tmp_path / "no-back.png", _unlike(bare))
    page.screenshot(path=tmp_path / "inactive.png")

    leg = page.get_by_role("slider", name="Leg length")
    assert sent_by(lambda: leg.press("Home"))["ring_height"] == 0.625
    expect(row("ring_height").get_by_role("status")).to_have_text("0.188 m")
    expect(page.get_by_role("slider", name="Ring height")).to_have_attribute("max", "0.625")

    toggle.click()
    expect(row("arm_height").get_by_role("status")).to_have_text("0.400 m")  # as it was before
    page.screenshot(path=tmp_path / "active.png")


def test_a_mesh_is_rebuilt_by_the_best_model_of_its_class(
    new_page: Callable[..., Page], site: Site, tmp_path: Path
) -> None:
    compiled = compile_model(armchair())
    path = tmp_path / "found chair.off"
    compiled.instance(compiled.values_from_mapping({"armrests": 0, "back": 2, "leg_length": 1.5})).save(path)
    with connected(site.url, ready_within_s=PATIENCE_S) as client:
        mesh = client.upload("/v1/meshes", path)
        body = {"mesh_id": mesh["id"], "class_name": "chair"}
        accepted = client.post("/v1/estimations", body)
        client.follow(accepted["job"])
    page = new_page(f"#/estimations/{accepted['id']}")
    result = page.get_by_test_id("estimation-result")
    expect(result).to_be_visible()
    expect(result.get_by_test_id("models-tried")).to_contain_text("Rebuilt with Armchair, out of 2 models")
    table = result.get_by_test_id("parameter-table")
    expect(table.get_by_role("row", name="Back")).to_contain_text("high back")
    expect(table.get_by_role("row", name="Armrest height")).to_contain_text("inactive")
    expect(table.get_by_role("row", name="Leg length")).to_contain_text(re.compile(r"Determined|Up to scale"))
    expect(result.get_by_test_id("residuals")).to_contain_text("of the mesh")
    page.screenshot(path=tmp_path / "class.png", full_page=True)

    # Each view is another picture: both meshes, the fit alone, and the colors of either.
    stage = _drawn(page, "mesh ")
    pictures = [_picture(stage, tmp_path / "overlay.png")]
    views = page.get_by_role("group", name="View of the fit")
    sides = page.get_by_role("group", name="Surface in colors")
    for button in (
        views.get_by_role("button", name="Fit", exact=True),
        views.get_by_role("button", name="Residuals"),
        sides.get_by_role("button", name="Fitted model"),
    ):
        button.click()
        pictures.append(_picture(stage, tmp_path / f"view-{len(pictures)}.png", _unlike(pictures[-1])))
    expect(page.get_by_text("on the other surface")).to_be_visible()
    views.get_by_role("button", name="Overlay").click()
    _picture(stage, tmp_path / "overlay-again.png", _like(pictures[0]))

    page.get_by_role("button", name="Estimate again").click()
    with page.expect_request(lambda request: request.url.endswith("/v1/estimations")) as asked:
        page.get_by_label("Model", exact=True).select_option("Any chair: best of 2")
        page.get_by_role("button", name="Rebuild it").click()
    assert asked.value.post_data_json["class_name"] == "chair"
    expect(page).not_to_have_url(re.compile(accepted["id"]))
    expect(result).to_be_visible()


def test_thumbnails_come_when_they_are_drawn(new_page: Callable[..., Page]) -> None:
    page = new_page()
    page.wait_for_function(
        "() => { const all = [...document.querySelectorAll('.thumbnail img')];"
        " return all.length === 4 && all.every((image) => image.naturalWidth > 0); }",
    )
    expect(page.get_by_test_id("thumbnail-fallback")).to_have_count(0)


def test_a_refused_file_says_what_is_wrong_and_where(new_page: Callable[..., Page], tmp_path: Path) -> None:
    page = new_page()
    broken = tmp_path / "broken.off"
    broken.write_text("OFF\nthree four\n")
    page.get_by_test_id("mesh-file").set_input_files(broken)
    alert = page.get_by_role("alert")
    expect(alert).to_contain_text("broken.off")
    expect(alert).to_contain_text("line 2")
    alert.get_by_role("button", name="Dismiss").click()
    expect(alert).to_have_count(0)


def test_from_an_unknown_mesh_to_its_parameters(new_page: Callable[..., Page], lamp_file: Path, tmp_path: Path) -> None:
    page = new_page()
    streams: list[str] = []
    page.on(
        "response",
        lambda answer: streams.append(answer.headers["content-type"]) if "/events" in answer.url else None,
    )
    _drop(page, lamp_file)
    expect(page.get_by_role("heading", name="found lamp.off").first).to_be_visible()
    stage = _drawn(page, "mesh ")
    query_alone = _picture(stage, tmp_path / "query.png")

    # What it is was asked at once; more can be asked for.
    expect(page.get_by_test_id("probabilities")).to_contain_text("Classifier “test”")
    page.get_by_role("button", name="Classify again").click()
    page.get_by_text("How it learned").click()
    expect(page.get_by_role("img", name="Loss by epoch").locator("polyline")).to_have_count(2)
    expect(page.get_by_text("of the held-out variations get their class")).to_be_visible()
    page.get_by_label("Also fit the likeliest classes to it").check()
    page.screenshot(path=tmp_path / "learning.png")
    page.get_by_role("button", name="Classify", exact=True).click()
    probabilities = page.get_by_test_id("probabilities")
    expect(page.get_by_test_id("fits").get_by_role("listitem").first).to_contain_text("fitted")
    expect(probabilities.get_by_role("listitem").first).to_contain_text("Lamp")
    expect(page.get_by_test_id("answer")).to_contain_text("Lamp")  # as the class, or as the nearest one
    page.get_by_text("Pictures that were looked at").click()
    pictures = page.get_by_role("img", name="The mesh as the classifier saw it")
    expect(pictures).to_be_visible()
    expect(pictures).to_have_js_property("complete", True)
    assert pictures.evaluate("image => image.naturalWidth") >= 224
    expect(page.get_by_label("Model", exact=True).locator("option:checked")).to_have_text("Lamp (most probable)")

    page.get_by_label("Unit of the file").select_option("mm")
    page.get_by_role("button", name="Rebuild it").click()
    progress = page.get_by_role("progressbar", name="Estimating parameters")
    result = page.get_by_test_id("estimation-result")
    expect(progress.or_(result).first).to_be_visible()
    page.screenshot(path=tmp_path / "progress.png")
    expect(result).to_be_visible()
    expect(progress).to_have_count(0)
    assert any(kind.startswith("text/event-stream") for kind in streams)

    expect(result.get_by_text(re.compile(r"^Layer [123]$"))).to_be_visible()
    rows = result.get_by_test_id("parameter-table").get_by_role("row")
    expect(rows).to_have_count(3)
    expect(rows.nth(1)).to_contain_text(re.compile(r"Length of the post.*\d+(\.\d+)? mm"))

    # Both meshes are there: each switch changes the picture.
    legend = page.get_by_role("list", name="Meshes in the view")
    both = _picture(stage, tmp_path / "both.png", _unlike(query_alone))
    legend.get_by_role("button", name="Fitted model").click()
    without_fit = _picture(stage, tmp_path / "without-fit.png", _unlike(both))
    legend.get_by_role("button", name="Query").click()
    _picture(stage, tmp_path / "without-both.png", _unlike(without_fit))
    for name in ("Query", "Fitted model"):
        legend.get_by_role("button", name=name).click()
    _picture(stage, tmp_path / "both-again.png", _like(both))
    page.screenshot(path=tmp_path / "result.png")

    # The address leads back to the same result; the parameters open in the model.
    again = new_page(page.url.split("/", 3)[3])
    expect(again.get_by_test_id("parameter-table")).to_be_visible()
    again.get_by_role("link", name="Open in model").click()
    _drawn(again, "model ")
    expect(again.locator('[data-parameter="post_length"]').get_by_role("status")).not_to_have_text("100 mm")


def test_an_estimation_can_be_cancelled(new_page: Callable[..., Page], site: Site, lamp_file: Path) -> None:
    with connected(site.url, ready_within_s=PATIENCE_S) as client:
        mesh = client.upload("/v1/meshes", lamp_file)
        settings = {"estimator": "reference", "samples": 100_000}
        accepted = client.post(
            "/v1/estimations", {"mesh_id": mesh["id"], "model_id": site.lamp_id, "settings": settings}
        )
    page = new_page(f"#/estimations/{accepted['id']}")
    job = page.get_by_test_id("job-progress")
    expect(job).to_have_attribute("data-state", "running")
    job.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text(re.compile("was cancelled|was stopped"))).to_be_visible()
    expect(job).to_have_count(0)


def test_meshes_of_a_class_are_found_in_a_collection(new_page: Callable[..., Page], site: Site, tmp_path: Path) -> None:
    compiled = compile_model(site.lamp)
    with connected(site.url, ready_within_s=PATIENCE_S) as client:
        for number, length in enumerate((0.6, 1.9)):
            mesh = compiled.instance(compiled.values_from_mapping({"post_length": length}))
            mesh.save(tmp_path / f"lamp {number}.ply")
            client.upload("/v1/meshes", tmp_path / f"lamp {number}.ply")
        crate = compile_model(ProceduralModel.load(_write_crate_model(tmp_path)))
        for number, height in enumerate((0.3, 1.5)):
            crate.instance(crate.values_from_mapping({"height": height})).save(tmp_path / f"crate {number}.ply")
            client.upload("/v1/meshes", tmp_path / f"crate {number}.ply")
    page = new_page()
    page.get_by_role("link", name="Index meshes").click()
    page.get_by_label("Name").fill("Some furniture")
    page.get_by_text("Some", exact=True).click()
    for name in ("lamp 0.ply", "lamp 1.ply", "crate 0.ply", "crate 1.ply"):
        page.get_by_role("checkbox", name=name).check()
    page.screenshot(path=tmp_path / "form.png")
    page.get_by_role("button", name="Start indexing").click()
    expect(page.get_by_role("heading", name="Some furniture")).to_be_visible()
    page.get_by_label("Class", exact=True).select_option("Lamp")
    page.get_by_role("button", name="Find meshes").click()
    ranking = page.get_by_test_id("ranking")
    expect(ranking).to_be_visible()
    names = [row.get_by_role("link").inner_text() for row in ranking.get_by_role("listitem").all()]
    assert sorted(names[:2]) == ["lamp 0.ply", "lamp 1.ply"]
    assert len(names) == 4
    sheet = page.get_by_role("img", name="Lamp: pictures of the first meshes found")
    expect(sheet).to_be_visible()
    page.wait_for_function("image => image.naturalWidth > 0", arg=sheet.element_handle())
    page.screenshot(path=tmp_path / "found.png")

    # The address leads back to the same ranking; a mesh of it opens.
    again = new_page(page.url.split("/", 3)[3])
    again.get_by_test_id("ranking").get_by_role("link").first.click()
    expect(again.get_by_role("heading", name=names[0]).first).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_fits_a_phone(new_page: Callable[..., Page], site: Site, scheme: str, tmp_path: Path) -> None:
    page = new_page(f"#/models/{site.lamp_id}", width=390, height=844, scheme=scheme)
    _drawn(page, "model ")
    page.evaluate(  # a class of many models is a row that scrolls by itself
        """for (const cards of document.querySelectorAll(".model-cards"))
             for (let i = 0; i < 5; i++) cards.append(cards.firstElementChild.cloneNode(true));"""
    )
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    background = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
    brightness = float(np.mean([int(number) for number in re.findall(r"\d+", background)[:3]]))
    assert (brightness > 128) == (scheme == "light")
    page.screenshot(path=tmp_path / "phone.png", full_page=True)


def test_the_view_turns_from_the_keyboard(new_page: Callable[..., Page], site: Site, tmp_path: Path) -> None:
    page = new_page(f"#/models/{site.lamp_id}")
    stage = _drawn(page, "model ")
    before = _picture(stage, tmp_path / "before.png")
    stage.focus()
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    _picture(stage, tmp_path / "after.png", _unlike(before))


def _drop(page: Page, path: Path) -> None:
    """Drop a file on the page as a browser does."""
    transfer = page.evaluate_handle(
        """([name, text]) => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([text], name));
            return transfer;
        }""",
        [path.name, path.read_text()],
    )
    for event in ("dragenter", "dragover", "drop"):
        page.dispatch_event("body", event, {"dataTransfer": transfer})
