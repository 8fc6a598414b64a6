"""Tyre marks and dust in pictures; the sound of a car as it would be heard, rendered to memory."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from tests.viewer.hand_scenes import floats
from tests.viewer.test_drawing import at, ball, scene
from tests.viewer.test_player import Opened
from tests.viewer.test_player import opened as opened
from tests.viewer.test_worlds_drawn import around, level

pytestmark = pytest.mark.slow

RATE = 24_000
COLUMNS = ["engine_speed", "speed", "used.throttle"]
_DRIVE = """([rows, kind]) => {
  window.effect?.dispose();
  window.effect = new ALi3Viewer[kind](view, {});
  for (const [time, epoch, numbers] of rows) {
    const lookup = name => numbers[name];
    view.update(lookup);
    effect.update(lookup, time, epoch);
  }
  view.render();
  return [effect.count, effect.problem];
}"""
_GO_ON = """rows => {
  for (const [time, epoch, numbers] of rows) {
    view.update(name => numbers[name]);
    effect.update(name => numbers[name], time, epoch);
  }
}"""
_SOUND = """async ([columns, numbers, seconds, rate, constants]) => {
  const context = new OfflineAudioContext(1, seconds * rate, rate);
  const sound = new ALi3Viewer.CarSound({ columns, constants, context });
  await sound.start();
  sound.update(name => numbers[0][name], 0);
  const step = 0.05;
  for (let k = 0; k * step < seconds; k++) {
    const now = numbers[Math.min(numbers.length - 1, Math.floor(k * step / seconds * numbers.length))];
    if (k === 0) sound.update(name => now[name], step);
    else context.suspend(k * step).then(() => { sound.update(name => now[name], (k + 1) * step); context.resume(); });
  }
  const buffer = await context.startRendering();
  return [Array.from(buffer.getChannelData(0)), sound.problem];
}"""


def tyre_scene(surface: str) -> dict[str, Any]:
    """A body with one tyre on a level terrain at height 0."""
    columns = {part: [f"wheel.{part}_{axis}" for axis in "xyz"] for part in ("contact", "normal", "axis")}
    arrow = {"name": "tyre", "tyre": columns | {"forces": ["wheel.Fx", "wheel.Fy", "wheel.Fz"]}}
    return scene(focus="body", shapes=[ball(radius=0.02)], roads=[level(0.0, surface)], arrows=[arrow], extent=4.0)


def tyre(x: float, **more: float) -> dict[str, float]:
    numbers = {f"wheel.{name}": 0.0 for name in ("contact_y", "contact_z", "normal_x", "normal_y", "axis_x", "axis_z")}
    numbers |= {"wheel.contact_x": x, "wheel.normal_z": 1.0, "wheel.axis_y": 1.0, "wheel.Fx": 0.0, "wheel.Fy": 0.0}
    numbers |= {"wheel.Fz": 2000.0, "wheel.slip": 0.0, "wheel.slip_angle": 0.0, "wheel.omega": 0.0, "speed": 10.0}
    return numbers | at(x, 0, 0.3) | more


def run(drawn: Any, kind: str, surface: str, slip: Any, end: float = 12.0, quality: str = "medium") -> int:
    """Drive along x at 10 m/s; slip is a function of x."""
    drawn.show(tyre_scene(surface), tyre(0.0), camera="top", quality=quality)
    rows = [[x / 10.0, 1, tyre(float(x), **{"wheel.slip": slip(x)})] for x in np.arange(0.0, end, 0.1)]
    count, problem = drawn.ask(_DRIVE, [rows, kind])
    assert problem == ""
    return int(count)


def test_a_locked_wheel_draws_a_dark_strip_where_it_slid(drawn):
    run(drawn, "TyreMarks", "concrete", lambda x: -1.0 if x > 9.0 else 0.0, quality="draft")
    picture = drawn.picture()
    on, before, beside = ((10.5, 0.0), (8.0, 0.0), (10.5, 1.0))
    dark, clean, other = (around(picture, drawn.project((*place, 0.0)), 0).mean() for place in (on, before, beside))
    assert dark < 0.6 * other
    assert clean > 0.8 * other


def split_ground(factor: float) -> dict[str, Any]:
    """Level ground of points every 0.5 m, dry at the left of y = 0 and of a factor of friction at the right."""
    frictions = np.where(np.arange(-40, 41) * 0.5 < -0.1, factor, 1.0)[None].repeat(81, axis=0)
    grid = {"kind": "grid", "origin": [-20.0, -20.0], "spacing": [0.5, 0.5], "shape": [81, 81]}
    return grid | {"heights": floats(np.zeros(81 * 81)), "frictions": floats(frictions)}


@pytest.mark.parametrize(("factor", "marks"), [(1.0, True), (0.6, False)])
def test_a_tyre_that_slides_on_a_slick_surface_leaves_no_mark(drawn, factor, marks):
    """The wheel runs at y = -3 m, on wet ground; beside it the ground is dry."""
    sliding = [tyre(float(x), **{"wheel.contact_y": -3.0, "wheel.slip": -1.0}) for x in np.arange(0.0, 12.0, 0.1)]
    drawn.show(tyre_scene("asphalt") | {"roads": [split_ground(factor)]}, tyre(0.0), camera="top")
    count, problem = drawn.ask(_DRIVE, [[[0.01 * k, 1, row] for k, row in enumerate(sliding)], "TyreMarks"])
    assert problem == ""
    assert (count > 50) == marks


@pytest.mark.parametrize("quality", ["draft", "medium"])
def test_ice_beside_dry_ground_has_no_dark_line(drawn, quality):
    """Its edge is nowhere darker than the darker side, which wet ground between them would be."""
    drawn.show(scene(focus="body", roads=[split_ground(0.15)], extent=1.0), at(0, 0, 0), camera="top", quality=quality)
    (u, v), (_, v_at_1) = (drawn.project((0.0, y, 0.0)) for y in (0.0, 1.0))
    across = drawn.picture()[:, : int(u) - 10].mean(axis=(1, 2))
    y = (np.arange(len(across)) + 0.5 - v) / (v_at_1 - v)
    dry, ice, edge = (across[(y > low) & (y < high)] for low, high in ((0.2, 0.8), (-1.3, -0.7), (-0.55, 0.1)))
    assert ice.mean() > 1.5 * dry.mean()
    assert edge.min() > 0.93 * dry.min()


def test_marks_of_a_draft_have_a_quarter_of_the_sections_and_the_same_ends(drawn):
    def span(quality):
        run(drawn, "TyreMarks", "concrete", lambda x: -1.0 if 2.0 < x < 8.0 or x > 10.0 else 0.0, 30.0, quality)
        return drawn.ask("effect.mesh.geometry.drawRange.count / 3")

    fine, draft = span("medium"), span("draft")
    assert fine > 250
    assert fine / 4 < draft < fine / 3.5
    picture = drawn.picture()
    middle = np.array([around(picture, drawn.project((x, 0.0, 0.0)), 0).mean() for x in (29.0, 28.7, 28.4, 28.1, 27.8)])
    beside = around(picture, drawn.project((28.4, 1.0, 0.0)), 0).mean()
    assert (middle < 0.6 * beside).all(), "no gap in a mark"


def test_marks_of_a_replay_end_at_a_reset(opened: Callable[..., Opened]) -> None:
    """A wheel slides for 3 m, is put 2 m ahead, which is less than a gap, and slides on."""
    x = np.linspace(0.0, 3.0, 61)
    places = np.r_[x, x + 5.0]
    rows = [tyre(float(place), **{"wheel.slip": -1.0}) for place in places]
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    begun = """() => {
      const { tracks } = window.player.drawnRuns[0].traces.marks;
      const [ring] = tracks.rings;
      const rows = Array.from({ length: ring.count }, (_, k) => [...tracks.row(ring, k)]);
      return rows.filter((row) => row[6] === 0).map((row) => row[0]);
    }"""
    epoch = np.repeat([0, 1], 61)
    page = opened(Recording(tyre_scene("concrete"), np.linspace(0.0, 1.0, 122), columns, epoch=epoch))
    page.seek(1.0)
    assert page(begun) == pytest.approx([0.0, 5.0])


def test_marks_stay_on_the_earth_when_the_focus_goes_far(drawn):
    """The places of marks are counted again every 500 m: they are drawn where they were."""
    run(drawn, "TyreMarks", "concrete", lambda x: -1.0)
    far = [[10.0 + x, 1, tyre(float(x), **{"wheel.Fz": 0.0})] for x in (900.0, 6.0)]
    drawn.ask(_GO_ON, far)
    picture = drawn.picture()
    dark, other = (around(picture, drawn.project((6.5, y, 0.0)), 0).mean() for y in (0.0, 1.0))
    assert dark < 0.6 * other


def test_gravel_is_thrown_up_behind_the_wheel_and_asphalt_is_not(drawn):
    assert run(drawn, "Dust", "asphalt", lambda x: 0.01) == 0
    assert run(drawn, "Dust", "gravel", lambda x: 0.01) > 5
    drawn.ask("view.camera('side')")
    with_dust = drawn.picture()
    drawn.ask("effect.points.visible = false")
    without = drawn.picture()
    changed = np.abs(with_dust - without).max(axis=2) > 8
    columns = np.nonzero(changed)[1]
    assert len(columns) > 50
    assert columns.mean() < 150  # x points to the right of the picture: it hangs behind the wheel


def heard(
    drawn: Any, numbers: Any, columns: list[str] = COLUMNS, seconds: float = 1.0, **constants: float
) -> np.ndarray:
    listed = numbers if isinstance(numbers, list) else [numbers]
    samples, problem = drawn.ask(_SOUND, [columns, listed, seconds, RATE, constants])
    assert problem == ""
    return np.array(samples)


def peak(samples: np.ndarray) -> float:
    """Frequency of the strongest line of the last half, Hz."""
    part = samples[len(samples) // 2 :]
    spectrum = np.abs(np.fft.rfft(part * np.hanning(len(part))))
    return float(np.argmax(spectrum) * RATE / len(part))


def test_an_engine_is_heard_at_its_firings(drawn):
    """Four cylinders, four strokes: two firings a revolution; lines of the spectrum are 2 Hz apart."""
    samples = heard(drawn, {"engine_speed": 300.0, "speed": 0.0, "used.throttle": 0.1})
    assert peak(samples) == pytest.approx(2.0 * 300.0 / (2.0 * np.pi), abs=2.0)
    assert 0.01 < np.abs(samples).max() < 0.99


def test_a_motor_and_the_squeal_of_tyres_are_heard(drawn):
    """Eight waves a revolution; a band that is louder where a tyre slips."""
    numbers = {"motor_speed": 200.0, "motor_torque": 150.0}
    samples = heard(drawn, numbers, ["motor_speed", "motor_torque"], **{"drive.max_torque": 210.0})
    assert peak(samples) == pytest.approx(8.0 * 200.0 / (2.0 * np.pi), abs=2.0)
    columns, levels = ["speed", "wheel.slip", "wheel.slip_angle", "wheel.Fz"], []
    for slip in (0.15, 0.5):
        numbers = {"speed": 15.0, "wheel.slip": slip, "wheel.slip_angle": 0.0, "wheel.Fz": 2500.0}
        samples = heard(drawn, numbers, columns, 0.6)[RATE // 4 :]
        frequency = np.fft.rfftfreq(len(samples), 1 / RATE)
        levels.append(np.abs(np.fft.rfft(samples))[(frequency > 700) & (frequency < 1200)].mean())
    assert levels[1] > 1.44 * levels[0]


def test_a_jump_of_the_throttle_makes_no_click(drawn):
    """No sample differs from the one before by more than the loudest steady tone makes it."""
    low, high = ({"engine_speed": 300.0, "speed": 0.0, "used.throttle": value} for value in (0.0, 1.0))
    steady = heard(drawn, high)
    jumping = heard(drawn, [low, high, low, high])
    assert np.abs(np.diff(jumping)).max() < 1.3 * np.abs(np.diff(steady)).max()


def test_without_new_numbers_the_sound_fades(drawn):
    code = _SOUND.replace("k * step < seconds", "k * step < 0.3")
    numbers = {"engine_speed": 300.0, "speed": 0.0, "used.throttle": 0.5}
    samples = np.array(drawn.ask(code, [COLUMNS, [numbers], 2.0, RATE, {}])[0])
    assert np.abs(samples[RATE // 5 : RATE // 3]).max() > 0.02
    assert np.abs(samples[-RATE // 4 :]).max() < 1e-3


def test_without_audio_one_sentence_is_shown_and_the_page_continues(drawn):
    notice = drawn.ask(
        """async columns => {
          const kept = [window.AudioContext, window.webkitAudioContext];
          window.AudioContext = window.webkitAudioContext = undefined;
          const sound = new ALi3Viewer.CarSound({ columns });
          await sound.start();
          sound.update(() => 1, 0);
          sound.mute(true);
          sound.update(null);
          await sound.dispose();
          [window.AudioContext, window.webkitAudioContext] = kept;
          return sound.problem;
        }""",
        COLUMNS,
    )
    assert "no sound" in notice
    assert "goes on" in notice
