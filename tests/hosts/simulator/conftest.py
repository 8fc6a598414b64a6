"""FMUs of small scenes, a clock that the tests move, and a server whose car needs no FMU."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.hosts.simulator.served import FakeCar, serving

TESTS = Path(__file__).parents[2]
_SCENES = {"sledge": TESTS / "hosts" / "scenes.py", "switched": TESTS / "hosts" / "scenes.py"}
_SCENES |= {"reach": TESTS / "fmu" / "scenes.py"}


@pytest.fixture(scope="session")
def fmu(scene_fmu: Callable[..., Path]) -> Callable[[str], Path]:
    """The FMU of a scene: sledge (a car by its names, in the plane), reach (can be pulled beyond its reach),
    switched (an input is a whole number), prototype_car; each is built once."""
    return lambda scene: scene_fmu(f"{_SCENES[scene]}:{scene}" if scene in _SCENES else scene)


@pytest.fixture
def fmus(fmu: Callable[[str], Path]) -> dict[str, Path]:
    """Sledges whose drives are recorded."""
    return {scene: fmu(scene) for scene in ("sledge", "switched")}


class FakeClock:
    """A clock that only the tests advance; a sleep may end late."""

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


@pytest.fixture
def car() -> FakeCar:
    return FakeCar()


@pytest.fixture
def served(car: FakeCar) -> Iterator[Any]:
    with serving(car) as found:
        yield found
