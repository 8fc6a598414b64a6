"""Reads the definition of a standard test: ``standard/NAME.toml``, with what ``shared.toml`` has for several tests."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import model_validator

from ali3.reading import read_toml
from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet, TestTables
from hosts.catalogue.record import Standard, StandardTest, TestRecord
from hosts.common.errors import HostError

_FOLDER = Path(__file__).parent / "standard"


@cache
def _shared() -> dict[str, Any]:
    """Plots, needs and titles that the files of several tests name."""
    return read_toml(_FOLDER / "shared.toml", HostError)


def _plots(plot: dict[str, Any]) -> list[dict[str, Any]]:
    """A plot, or a plot over time for each of the signals that it names."""
    if "signals" not in plot:
        return [plot]
    options = {name: value for name, value in plot.items() if name not in ("signals", "run", "line")}
    time = ["time, s", f"{plot['run']}.time"]
    return [
        {**options, "title": f"{title}, {plot['title']}", "x": time, "y": y}
        | {"lines": {plot.get("line", line): value.format(run=plot["run"])}}
        for title, y, value, line in (_shared()["signals"][name] for name in plot["signals"])
    ]


class TestFile(TestTables):
    """The content of the file of a test, with what it names of ``shared.toml``."""

    title: str
    needs: tuple[str, ...]
    standards: tuple[Standard, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _named(cls, content: dict[str, Any]) -> dict[str, Any]:
        settings = [{"name": name, **setting} for name, setting in content.get("settings", {}).items()]
        needs = [name for need in content["needs"] for name in _shared()["needs"].get(need, [need])]
        titles = _shared()["standards"]
        standards = [{"title": titles.get(s["name"], ""), **s} for s in content.get("standards", ())]
        parts = {
            name: {**part, "plots": [each for plot in part.get("plots", ()) for each in _plots(plot)]}
            for name, part in content.get("parts", {}).items()
        }
        return {**content, "settings": settings, "needs": needs, "standards": standards, "parts": parts}


def file_of_test(name: str) -> TestFile:
    """Read ``standard/NAME.toml``."""
    return TestFile.model_validate(read_toml(_FOLDER / f"{name}.toml", HostError))


def standard_of(name: str, drive: Callable[[Sheet], None]) -> StandardTest:
    """The test that ``standard/NAME.toml`` describes, and whose runs `drive` makes and adds to a sheet."""
    about = file_of_test(name)

    def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
        sheet = Sheet(about, car, settings, progress)
        drive(sheet)
        return sheet.record()

    return StandardTest(name, about.title, perform, about.standards, about.settings, about.needs, about.why_not)
