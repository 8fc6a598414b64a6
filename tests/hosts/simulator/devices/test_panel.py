"""The panel of devices in a Chromium without a window, on virtual devices."""

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from hosts.common.errors import HostError
from tests.hosts.simulator.devices.haptics import Haptics
from tests.hosts.simulator.pages import until
from viewer import bundle

pytestmark = pytest.mark.slow  # a browser

WHEEL = "device Wheel"
_MAKE = """() => {
  window.panel = new ALi3Viewer.CalibrationPanel({ send: (message) => window.toHost(message) });
  document.body.append(panel.element);
  panel.show([]);
}"""


class Panel:
    """The panel and the host behind it."""

    def __init__(self, page: Any) -> None:
        self.page, self.run, self.refused, self.errors = page, None, list[str](), list[str]()
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.expose_function("toHost", self._message)
        page.set_content("<body style='margin:8px;width:340px'></body>")
        page.add_script_tag(content=bundle.bundle().read_text(encoding="utf-8"))
        page.evaluate(_MAKE)

    def _message(self, message: dict[str, Any]) -> None:
        try:
            self.run.devices.message(message)
        except HostError as error:
            self.refused.append(str(error))

    def at(self, what: str) -> Any:
        return self.page.locator(f'[data-a3="{what}"]').first

    def text(self, what: str) -> str:
        return str(self.at(what).inner_text())

    def show(self) -> list[dict[str, Any]]:
        """What the host sends many times a second."""
        state = self.run.devices.state()
        self.page.evaluate("devices => panel.show(devices)", state)
        return list(state)

    def until(self, what: Callable[[], Any]) -> Any:
        def shown() -> Any:
            self.show()
            return what()

        return until(shown)

    def mapping(self, name: str) -> dict[str, Any]:
        return dict(self.run.only()["mapping"].get(name, {}))


@pytest.fixture
def panel(chromium: Any, start: Any) -> Iterator[Panel]:
    page = chromium.new_page(viewport={"width": 360, "height": 900})
    page.set_default_timeout(60_000)
    opened = Panel(page)
    yield opened
    page.close()
    assert opened.errors == []
    assert opened.refused == []


def test_it_shows_devices_as_they_come_and_go(panel, start, attach):
    panel.run = start()
    panel.show()
    assert "No steering wheel" in panel.text("no devices")
    device = attach()
    panel.until(lambda: panel.at(WHEEL).count())
    assert panel.at("no devices").is_hidden()
    assert "Wheel (wheel)" in panel.text(WHEEL)
    device.pull_out()
    panel.until(lambda: panel.at(WHEEL).count() == 0)
    assert panel.at("no devices").is_visible()


def test_axes_are_chosen_inverted_and_halved(panel, start, wheel):
    panel.run = start()
    panel.show()
    panel.at("source brake").select_option("axis 1")
    panel.until(lambda: panel.mapping("brake")["source"] == "axis 1")
    before = panel.mapping("brake")["inverted"]
    panel.at("inverted brake").click()
    panel.until(lambda: panel.mapping("brake")["inverted"] != before)
    panel.at("part brake").select_option("lower half")
    panel.until(lambda: (panel.mapping("brake")["low"], panel.mapping("brake")["high"]) == (-1.0, 0.0))
    panel.at("dead zone brake").fill("0.2")
    panel.until(lambda: panel.mapping("brake")["dead_zone"] == 0.2)
    panel.until(lambda: panel.text("driven 1") == "drives brake")
    panel.at("source brake").select_option("none")
    panel.until(lambda: panel.mapping("brake") == {} and panel.text("driven 1") == "drives nothing")
    panel.at("reset mapping").click()
    panel.until(lambda: panel.text("driven 3") == "drives brake")


def test_what_is_chosen_by_keys_is_drawn_and_keeps_the_focus(panel, start, wheel):
    panel.run = start()
    panel.until(lambda: panel.at("inverted brake").is_visible())
    panel.at("source brake").focus()
    for key in ("ArrowDown", "Home", "Enter"):
        panel.page.keyboard.press(key)
    panel.until(lambda: panel.mapping("brake") == {} and not panel.at("inverted brake").is_visible())
    assert panel.page.evaluate("document.activeElement.getAttribute('data-a3')") == "source brake"
    for key in ("ArrowDown", "ArrowDown", "Enter"):
        panel.page.keyboard.press(key)
    panel.until(lambda: panel.mapping("brake") != {} and panel.at("inverted brake").is_visible())


def test_an_input_is_assigned_by_move_it_now(panel, start, wheel):
    panel.run = start()
    panel.show()
    panel.at("move hand_brake").click()
    panel.until(lambda: panel.at("moving").count() and panel.text("moving") == "pull the hand brake now")
    wheel.button(5, True)
    panel.until(lambda: panel.at("source hand_brake").input_value() == "button 5")
    assert panel.at("moving").count() == 0


def test_a_calibration_is_guided_by_texts_and_stored(panel, start, wheel):
    panel.run = start()
    panel.show()
    panel.at("calibrate").click()
    panel.until(lambda: panel.at("calibration").count() and "Let go of everything" in panel.text("calibration"))
    assert panel.at("finish").is_disabled()
    panel.until(lambda: "fully to the left" in panel.text("calibration"))
    for k, value in ((0, -0.8), (0, 0.8), (0, 0.0), (3, -0.5), (3, 1.0)):
        wheel.axis(k, value)
        panel.until(lambda k=k, value=value: abs(panel.run.only()["axes"][k] - value) < 1e-3)
    panel.at("finish").click()
    panel.until(lambda: panel.at("calibrate").count())
    assert panel.mapping("brake")["low"] == pytest.approx(-0.47, abs=1e-3)
    assert panel.at("part brake").input_value() == "calibrated"
    panel.at("calibrate").click()
    panel.until(lambda: "fully to the left" in panel.text("calibration"))
    wheel.axis(3, -0.9)
    panel.until(lambda: abs(panel.run.only()["axes"][3] + 0.9) < 1e-3)
    panel.at("cancel").click()
    panel.until(lambda: panel.at("calibrate").count())
    assert panel.mapping("brake")["low"] == pytest.approx(-0.47, abs=1e-3)


def test_the_force_is_set_and_tested(panel, start, wheel, monkeypatch):
    haptics = Haptics().install(monkeypatch)
    panel.run = start(lambda: None)
    panel.until(lambda: panel.run.only()["force"])
    panel.show()
    panel.page.locator("summary", has_text="Wheel and force").click()
    assert panel.text("force") == "Its motor works."
    panel.at("setting rotation").fill("540")
    panel.at("setting rotation").press("Enter")
    panel.until(lambda: panel.run.only()["settings"]["rotation"] == 540.0)
    panel.until(lambda: panel.at("setting rotation").input_value() == "540")
    panel.at("test force").click()
    panel.until(lambda: max(haptics.levels) > 0)
    assert "should turn to the left" in panel.text("force test")
    panel.at("force inverted").click()
    panel.until(lambda: panel.run.only()["settings"]["force_inverted"])


def test_a_field_that_is_typed_into_is_left_alone(panel, start, wheel):
    panel.run = start()
    panel.show()
    panel.page.locator("summary", has_text="Wheel and force").click()
    panel.at("setting rotation").fill("36")
    panel.run.devices.set_settings(panel.run.only()["id"], {"damper": 0.7})
    end = time.monotonic() + 0.3
    while time.monotonic() < end:
        panel.show()
    assert panel.at("setting rotation").input_value() == "36"
    panel.at("setting rotation").press("Tab")
    panel.until(lambda: panel.at("setting damper").input_value() == "0.7")
    assert panel.run.only()["settings"]["rotation"] == 36.0
