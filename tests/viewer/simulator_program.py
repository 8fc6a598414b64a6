"""A substitute for the program that drives the car: frames that a test sends, and messages of the page."""

import json
import struct
from typing import Any

import numpy as np

from ali3.scene.recording import Recording
from tests.in_browser import SELDOM, wait_for, wait_until
from viewer.html_document import html_document

ADDRESS = "http://simulator.test"
RUNNING, REFUSED, BEHIND = 1, 2, 4
_BINS = [[2e-5, 3], [5e-5, 4000], [1e-4, 900], [8e-4, 12], [1.9e-3, 1], [4e-3, 2]]
_SPREAD = {"median": 6e-5, "p99": 2e-4, "p999": 9e-4, "largest": 4e-3, "bins": _BINS}
REPORT: dict[str, Any] = {
    **{"type": "report", "step": 0.002, "steps": 4918, "simulated": 9.836, "wall": 9.84, "missed": 2},
    **{"missed_by": {"ran": 1, "others": 0, "stolen": 1}, "cost": _SPREAD, "lateness": _SPREAD},
}
"""Times of the steps."""
_HEADER = struct.Struct("<4I10d")


def variables(recording: Recording, inputs: tuple[str, ...]) -> list[dict[str, Any]]:
    """Variables of an FMU with the columns of a recording."""
    rows: list[dict[str, Any]] = [{"name": n, "causality": "input", "type": "Real", "start": 0} for n in inputs]
    for name in recording.columns:
        if name not in inputs:
            unit = recording.units.get(name, "")
            rows.append({"name": name, "causality": "output", "type": "Real", "unit": unit})
    return rows


class Program:
    """Serves the page in a Chromium of playwright and sends it frames.

    Parameters
    ----------
    page : playwright Page
        Empty; `open` loads the simulator into it.
    recording : Recording
        Of a car: frames have its columns, the page draws its scene.
    inputs : tuple of str
    world : dict
        As in the hello.
    roads, scenery : list, optional
        Of the drawing of the world; those of the scene where None.
    """

    def __init__(
        self,
        page: Any,
        recording: Recording,
        inputs: tuple[str, ...] = ("steering", "throttle", "brake", "hand_brake", "selector"),
        world: dict[str, Any] | None = None,
        roads: list[Any] | None = None,
        scenery: list[Any] | None = None,
        **hello: Any,
    ) -> None:
        self.page = page
        self.recording = recording
        self.heard: list[dict[str, Any]] = []
        self.errors: list[str] = []
        self.sockets: list[Any] = []
        self.names = [*inputs, *(name for name in recording.columns if name not in inputs)]
        self.inputs = inputs
        self.values: dict[str, float] = {}
        scene = dict(recording.scene or {})
        self._world = {"roads": scene.pop("roads", []) if roads is None else roads, "scenery": scenery or []}
        scene.pop("roads", None)
        self.hello = {
            "type": "hello",
            "version": 1,
            "description": {"modelName": "Car", "variables": variables(recording, inputs)},
            "scene": scene,
            "columns": self.names,
            "constants": {
                **{"vehicle.wheelbase": 2.3, "vehicle.front_wheel_angle_max": 0.525},
                **{"vehicle.tyre_friction_front": 1.0, "vehicle.tyre_friction_rear": 1.0},
            },
            "step": 0.002,
            "world": world or {"name": "here", "places": [], "bounds": [-200, -200, 200, 200]},
            "recording": "",
            **hello,
        }
        self.count = 0
        self.epoch = 1
        page.add_init_script(SELDOM)  # it draws all the time, on a processor of the tests
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", lambda m: m.type == "error" and self.errors.append(m.text))

    def open(self, query: str = "") -> None:
        """Load the page and wait until it is ready."""
        html = html_document("A simulator", {}, "Simulator", "'self'")
        self.page.route(f"{ADDRESS}/{query}", lambda route: route.fulfill(body=html, content_type="text/html"))
        self.page.route(f"{ADDRESS}/world*", lambda route: route.fulfill(body=json.dumps(self._world)))
        self.page.route_web_socket("**/drive*", self._connected)
        self.page.goto(f"{ADDRESS}/{query}")
        wait_until(self.page, "window.player?.cockpit")

    def _connected(self, socket: Any) -> None:
        self.sockets.append(socket)
        socket.on_message(lambda text: self.heard.append(json.loads(text)))
        self.say(self.hello)

    def say(self, message: dict[str, Any]) -> None:
        """A message of the program."""
        self.sockets[-1].send(json.dumps(message))

    def row(self, time: float) -> list[float]:
        """Values of the columns at a time, replaced by `values` where given."""
        t = self.recording.t
        k = int(np.clip(np.searchsorted(t, time), 0, len(t) - 1))
        own = {name: float(column[k]) for name, column in self.recording.columns.items()}
        return [float((own | self.values).get(name, 0.0)) for name in self.names]

    def send(self, time: float, flags: int = RUNNING, **header: float) -> None:
        """A frame at a time of the recording."""
        self.count += 1
        fields = {
            "count": round(time / 0.002) + 1e6 * self.epoch,
            "time": time,
            "speed": 1.0,
            "wall": 100.0 + time,
            "cost": 2e-4,
            "worst": 5e-4,
            "lateness": 1e-5,
            "missed": 0,
            "deadline": 0.002,
            "saved": time,
        } | header
        row = self.row(time)
        bytes_ = _HEADER.pack(0x31463341, self.epoch, flags, len(row), *fields.values())
        self.sockets[-1].send(bytes_ + np.asarray(row, "<f8").tobytes())

    def ask(self, expression: str) -> Any:
        """Value of an expression in the page."""
        return self.page.evaluate(expression)

    def text(self, what: str) -> str:
        """Text of an element by its accessible name."""
        return str(self.page.locator(f'[data-a3="{what}"]').first.text_content())

    def wanted(self) -> dict[str, list[Any]]:
        """Value and rate that hands wanted last, by input."""
        return {name: pair for m in self.heard if m["type"] == "want" for name, pair in m["values"].items()}

    def until_wanted(self, **pairs: list[Any]) -> None:
        """Wait until hands want these."""
        wait_for(self.page, lambda: self.wanted() == self.wanted() | pairs, lambda: (pairs, self.wanted()))

    def until_heard(self, message: dict[str, Any]) -> None:
        """Wait until the page has sent a message."""
        wait_for(self.page, lambda: message in self.heard, message)

    def commands(self) -> list[tuple[str, float]]:
        """Commands that the page has sent."""
        return [(m["name"], m["value"]) for m in self.heard if m["type"] == "command"]
