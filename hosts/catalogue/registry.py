"""The tests of the catalogue by name, each from ``standard/NAME.toml`` and the function ``drive`` of its module."""

import importlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import model_validator

from ali3.near_names import did_you_mean
from ali3.reading import read_toml
from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet, TestTables
from hosts.catalogue.standard_test import Standard, StandardTest, TestRecord
from hosts.common.errors import HostError

TESTS = (
    "steady_circle",
    "step_steer",
    "sine_steer",
    "chirp_steer",
    "sine_with_dwell",
    "double_lane_change",
    "straight_braking",
    "split_braking",
    "braking_in_a_turn",
    "power_off_in_a_turn",
    "kerb",
    "drop",
)
"""In the order in which they are done."""
_FOLDER = Path(__file__).parent / "standard"


@cache
def _read_shared() -> dict[str, Any]:
    """Signals, needs and titles of standards that the files of several tests name."""
    return read_toml(_FOLDER / "shared.toml", HostError)


def _expanded_plots(plot: dict[str, Any]) -> list[dict[str, Any]]:
    """The plot, or a plot over time for each of its signals."""
    if "signals" not in plot:
        return [plot]
    options = {name: value for name, value in plot.items() if name not in ("signals", "run", "line")}
    time = ["time, s", f"{plot['run']}.time"]
    return [
        {**options, "title": f"{title}, {plot['title']}", "x": time, "y": y}
        | {"lines": {plot.get("line", line): value.format(run=plot["run"])}}
        for title, y, value, line in (_read_shared()["signals"][name] for name in plot["signals"])
    ]


class TestFile(TestTables):
    """The content of the file of a test, with the entries of ``shared.toml`` that it names."""

    title: str
    needs: tuple[str, ...]
    standards: tuple[Standard, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _with_shared_entries(cls, content: dict[str, Any]) -> dict[str, Any]:
        settings = [{"name": name, **setting} for name, setting in content.get("settings", {}).items()]
        needs = [name for need in content["needs"] for name in _read_shared()["needs"].get(need, [need])]
        titles = _read_shared()["standards"]
        standards = [{"title": titles.get(s["name"], ""), **s} for s in content.get("standards", ())]
        parts = {
            name: {
                **part,
                "plots": [plot_line for plot in part.get("plots", ()) for plot_line in _expanded_plots(plot)],
            }
            for name, part in content.get("parts", {}).items()
        }
        return {**content, "settings": settings, "needs": needs, "standards": standards, "parts": parts}


def read_test_file(name: str) -> TestFile:
    """Read ``standard/NAME.toml``."""
    return TestFile.model_validate(read_toml(_FOLDER / f"{name}.toml", HostError))


@cache
def standard_test(name: str) -> StandardTest:
    """A test by its name. Raises `HostError` with the known names if there is no such test."""
    if name not in TESTS:
        hint = did_you_mean(name, TESTS, f"they are: {', '.join(TESTS)}")
        raise HostError(f"There is no test '{name}' in the catalogue{hint}")
    definition, module = read_test_file(name), importlib.import_module(f"hosts.catalogue.standard.{name}")

    def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
        sheet = Sheet(definition, car, settings, progress)
        module.drive(sheet)
        return sheet.record()

    return StandardTest(
        name, definition.title, perform, definition.standards, definition.settings, definition.needs, definition.why_not
    )
