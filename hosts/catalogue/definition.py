"""Reads what a standard test is from the file of its name in the folder ``standard``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pydantic import model_validator

from ali3.reading import read_toml
from hosts.catalogue.car import TestedCar
from hosts.catalogue.record import Setting, Standard, StandardTest, TestRecord
from hosts.catalogue.sheet import Sheet, TestTables
from hosts.common.errors import HostError

_FOLDER = Path(__file__).parent / "standard"


class TestFile(TestTables):
    """The file of a test."""

    title: str
    needs: tuple[str, ...]
    standards: tuple[Standard, ...] = ()
    settings: tuple[Setting, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _named(cls, content: dict[str, Any]) -> dict[str, Any]:
        settings = [{"name": name, **setting} for name, setting in content.get("settings", {}).items()]
        return {**content, "settings": settings}


def file_of_test(name: str) -> TestFile:
    """The file ``standard/NAME.toml``."""
    return TestFile.model_validate(read_toml(_FOLDER / f"{name}.toml", HostError))


def load_test(name: str, drive: Callable[[Sheet], None]) -> StandardTest:
    """The test that ``standard/NAME.toml`` describes, and whose runs `drive` makes and adds to a sheet."""
    about = file_of_test(name)

    def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
        sheet = Sheet(about, car, settings, progress)
        drive(sheet)
        return sheet.record()

    return StandardTest(name, about.title, perform, about.standards, about.settings, about.needs, about.why_not)
