"""FMUs of small scenes, and a clock that the tests move."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene

TESTS = Path(__file__).parents[2]
_SCENES = {"sledge": TESTS / "hosts" / "scenes.py", "switched": TESTS / "hosts" / "scenes.py"}
_SCENES |= {"reach": TESTS / "fmu" / "scenes.py"}


@pytest.fixture(scope="session")
def fmu(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Callable[[str], Path]:
    """The FMU of a scene: sledge (a car by its names, in the plane), reach (can be pulled beyond its reach),
    switched (an input is a whole number), prototype_car; each is built once."""
    made: dict[str, Path] = {}

    def build(scene: str) -> Path:
        if scene == "prototype_car":
            return Path(request.getfixturevalue("prototype_fmu"))
        if scene not in made:
            name, system = load_scene(f"{_SCENES[scene]}:{scene}")
            made[scene] = build_fmu(system, name, tmp_path_factory.mktemp(scene), [fmpy.platform])
        return made[scene]

    return build


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Sledges whose drives are recorded."""
    folder = tmp_path_factory.mktemp("fmus")
    made = {}
    for function in ("sledge", "switched"):
        name, system = load_scene(f"{_SCENES[function]}:{function}")
        made[function] = build_fmu(system, name, folder, [fmpy.platform])
    return made


class FakeClock:
    """Time passes only where it is told to; a sleep may wake late."""

    def __init__(self) -> None:
        self.time, self.wakes_late = 100.0, 0.0
        self.ran = self.waited = 0.0

    def now(self) -> float:
        return self.time

    def sleep_until(self, until: float) -> None:
        self.time = max(self.time, until + self.wakes_late)

    def work(self, seconds: float) -> None:
        self.time += seconds
        self.ran += seconds

    def wait_for_others(self, seconds: float) -> None:
        self.time += seconds
        self.waited += seconds

    def stand(self, seconds: float) -> None:
        self.time += seconds

    def spent(self) -> tuple[float, float]:
        return self.ran, self.waited


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock()
