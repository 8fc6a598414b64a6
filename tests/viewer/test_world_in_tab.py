"""A world in a page that runs an FMU: one file with its road, thin, its drawing and its places."""

import pytest

from hosts.simulator.command import main as simulator
from hosts.view.command import main as view
from tests.in_browser import SELDOM, wait_until
from tests.viewer.bars import check_bar

MOST_BYTES = 8e6
# An answer of the worker that comes while the page still unpacks would find nothing to draw it in.
SLOW_TO_UNPACK = """{
  const { Worker, Response } = window;
  let begun = false;
  window.Worker = class extends Worker { constructor(...given) { super(...given); begun = true; } };
  const { arrayBuffer } = Response.prototype;
  Response.prototype.arrayBuffer = async function () {
    if (begun) await new Promise((done) => setTimeout(done, 3000));
    return arrayBuffer.call(this);
  };
}"""


@pytest.mark.slow
def test_the_proving_ground_in_a_tab_is_one_file_and_the_car_drives_on_it(chromium, live_car, tmp_path, capsys):
    assert view([str(live_car), "--live", "--world", "proving_ground", "--no-open", "--out", str(tmp_path)]) == 0
    file = next(tmp_path.glob("*_live.html"))
    assert file.stat().st_size <= MOST_BYTES
    assert "Thin ground: its heights are off by at most" in capsys.readouterr().out
    page = chromium.new_page(viewport={"width": 640, "height": 360})
    page.add_init_script(SELDOM + SLOW_TO_UNPACK)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(file.as_uri())
    page.evaluate("async () => { await player.ready; }")
    assert page.evaluate("player.view.messages") == []
    assert page.evaluate("player.view.look.quality") == "draft", "here the processor draws"
    cost = page.evaluate("[player.view.renderer.info.render.calls, player.view.renderer.info.render.triangles]")
    assert 10 < cost[0] < 60
    assert 20_000 < cost[1] < 50_000
    page.keyboard.down("ArrowUp")
    wait_until(page, "player.get('speed') > 5", timeout=120)
    page.keyboard.up("ArrowUp")
    assert page.evaluate("player.stage.parts[0].effects.sound.mixer !== null"), "a key has switched the sound on"
    page.keyboard.press("m")
    assert page.evaluate("player.stage.parts[0].effects.sound.mixer.volume") == 0
    check_bar(page, ".a3-bar", 800)
    for key, camera in (
        ("1", "driver"),
        ("2", "chase"),
        ("3", "wheel FL"),
        ("3", "wheel FR"),
        ("4", "orbit"),
        ("5", "top"),
    ):
        page.keyboard.press(key)
        assert page.evaluate("player.view.cameras.name") == camera
    page.keyboard.press("H")  # as with caps lock
    assert "camera of the driver" in page.inner_text("[data-a3='help list']")
    page.keyboard.press("Escape")
    assert not page.locator("[data-a3='help list']").is_visible()
    page.evaluate("async () => { await player.pause(); }")  # else the car creeps away from the place
    place = page.evaluate("Object.keys(player.options.places)")[3]
    page.get_by_title("begin at a place of the world").select_option(place)
    start = page.evaluate("name => player.options.places[name]", place)
    wait_until(
        page,
        "([x, y]) => Math.hypot(player.view.origin[0] - x, player.view.origin[1] - y) < 5",
        [start["initial.x"], start["initial.y"]],
    )
    page.evaluate("async () => { await player.run(); }")
    page.keyboard.press("o")
    page.select_option("[data-a3=quality]", "medium")
    wait_until(page, "player.view.look.quality === 'medium' && player.view.renderer.info.render.triangles > 100000")
    assert errors == []
    page.close()


@pytest.mark.slow
def test_a_world_and_a_road_are_refused_together(live_car, tmp_path, capsys):
    wishes = ["--world", "proving_ground", "--road", "washboard.road"]
    assert view([str(live_car), "--live", *wishes, "--no-open", "--out", str(tmp_path)]) != 0
    assert "give it once" in capsys.readouterr().err
    assert list(tmp_path.glob("*.html")) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("world", "message"),
    [
        (None, "There is no world '"),
        ("bounds = [-50000, -50000, 50000, 50000]\nspacing = [10, 10]", "is 100000 m x 100000 m; at most 100 km2"),
    ],
    ids=["missing", "100 km"],
)
def test_worlds_that_cannot_be_are_one_sentence_at_each_door(live_car, tmp_path, capsys, world, message):
    file = tmp_path / "w.toml"
    if world is not None:
        file.write_text(f'kind = "world"\nname = "w"\n{world}\n', encoding="utf-8")
    tab = ["--live", "--no-open", "--out", str(tmp_path / "out")]
    for door, options in ((view, tab), (simulator, ["--headless", "--stop-time", "0.1"])):
        assert door([str(live_car), "--world", str(file), *options]) == 2
        errors = capsys.readouterr().err.strip().splitlines()
        assert len(errors) == 1
        assert message in errors[0]
    assert not list(tmp_path.rglob("*.html"))
