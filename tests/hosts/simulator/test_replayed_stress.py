"""A replay in a browser has the stress colours of the drive."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.recorded_view import recorded_view
from hosts.simulator.car import Car, CarSettings
from tests.in_browser import headless_chromium
from tests.in_process import build_fmu
from tests.viewer.stress_colours import stress_seen
from tests.viewer.test_player import Opened
from viewer.page_file import write_page

SCENES = Path(__file__).parents[1] / "scenes.py"
FULL = 60e6  # Pa, at the end of the colours
AREA = np.pi / 4.0 * (0.1**2 - 0.08**2)  # m2, of the bar


@pytest.mark.slow
def test_a_replay_is_coloured_by_the_stress_of_the_outputs(
    made_once: Callable[[str, Callable[[Path], None]], Path], tmp_path: Path
) -> None:
    """A bar is pulled more and more, with a reset in between; pixels in its middle against the output at that time."""
    driven: dict[float, float] = {}
    fmu = next(made_once("bar", lambda folder: build_fmu(folder, "--scene", f"{SCENES}:bar")).glob("*.fmu"))
    with Car(CarSettings(fmu, {}, record=tmp_path / "drive", step=0.002, paced=False, priority=False)) as car:
        place = car.names.index("bar.stress")

        def go_on(pull: float) -> None:
            car.want({"pull": (pull, 4e5)})
            goal = car.latest().count + 240
            car.command("step", 240)
            end = time.perf_counter() + 60.0
            while car.latest().count < goal:
                assert time.perf_counter() < end
                time.sleep(0.002)
            # at the very time of a reset a replay shows what was after it
            driven[0.002 * goal - 1e-6] = float(car.latest().values[place])

        for pull in (5e4, 1e5, 0.0, 1.6e5):
            go_on(pull)
        car.command("reset")
        go_on(-1.2e5)
    stresses = np.array([*driven.values()])
    assert stresses == pytest.approx(np.array([5e4, 1e5, 0.0, 1.6e5, -1.2e5]) / AREA, rel=0.01, abs=1e5)
    drive = read_recording(tmp_path / "drive")
    often = dict(zip(drive.names, drive.every, strict=True))
    assert {often[f"body.bar.mode_{k}"] for k in range(1, 7)} == {12}
    recording, sentences = recorded_view(tmp_path / "drive", "drive")
    assert (sentences, recording.missing) == ([], [])
    write_page(tmp_path / "drive.html", [recording], options={"camera": "side", "stress": True})
    with headless_chromium() as chromium:
        page = Opened(chromium, tmp_path / "drive.html")
        page("full => window.player.view.set({ stressMost: full })", FULL)
        for t, stress in driven.items():
            page.seek(t)
            x, y = page.place([0.5, 0.0, 0.0])
            assert stress_seen(page.picture()[y, x], FULL) == pytest.approx(abs(stress), abs=0.005 * FULL), t
        assert page("() => window.player.view.messages") == []
        assert "stress in MPa" in page.page.inner_text("[data-legend=stress]")
        assert page.said == []
