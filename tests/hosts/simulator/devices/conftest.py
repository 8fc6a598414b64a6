"""SDL without video, and `Devices` on virtual devices."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from hosts.simulator.devices import Devices, sdl

Attach = Callable[..., Any]
Start = Callable[..., Any]


@pytest.fixture(scope="session")
def sdl_started() -> Iterator[None]:
    pytest.importorskip("sdl2dll", reason="SDL is not installed")
    module = sdl.load()
    sdl.start(module)
    yield
    sdl.stop(module)


@pytest.fixture
def attach(sdl_started: None) -> Iterator[Attach]:
    """Plugs in a virtual device; all are pulled out at the end."""
    from tests.hosts.simulator.devices.virtual import VirtualDevice

    results: list[VirtualDevice] = []

    def attach(*arguments: Any, **named: Any) -> VirtualDevice:
        results.append(VirtualDevice(*arguments, **named))
        return results[-1]

    yield attach
    for device in results:
        device.pull_out()


@pytest.fixture
def wheel(attach: Attach) -> Any:
    """Plugged in, with its pedals at rest."""
    from tests.hosts.simulator.devices.virtual import rested

    return rested(attach())


class Run:
    """`Devices` that run, with what they told and want."""

    def __init__(self, folder: Path, torque: Any = None, **changed: Any) -> None:
        from tests.hosts.simulator.devices.virtual import ANGLE_MAX, INPUTS, RecordedArbiter

        self.arbiter, self.told = RecordedArbiter(), list[str]()
        options = {"inputs": INPUTS, "constants": {"vehicle.steering_wheel_angle_max": ANGLE_MAX}} | changed
        self.devices = Devices(self.arbiter, tell=self.told.append, folder=folder, torque=torque, **options)
        self.devices.__enter__()

    def only(self) -> dict[str, Any]:
        """State of the one device."""
        (state,) = self.devices.state()
        return state

    def said(self, words: str) -> bool:
        return any(words in sentence for sentence in self.told)


@pytest.fixture
def start(sdl_started: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Start]:
    """Starts `Devices`; at the end its threads are gone, and only then what is patched."""
    before = set(threading.enumerate())
    runs: list[Run] = []

    def start(torque: Any = None, **changed: Any) -> Run:
        runs.append(Run(tmp_path, torque, **changed))
        return runs[-1]

    yield start
    for run in runs:
        run.devices.close()
    assert set(threading.enumerate()) - before == set()
