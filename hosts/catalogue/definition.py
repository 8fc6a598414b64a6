"""Reads what a standard test is from the file of its name in the folder ``standard``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator

from ali3.reading import read_toml
from hosts.catalogue.record import MeasureText, Perform, Setting, Standard, StandardTest, WhyNot, always
from hosts.common.errors import HostError

_FOLDER = Path(__file__).parent / "standard"


class _TestFile(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    title: str
    needs: tuple[str, ...]
    standards: tuple[Standard, ...] = ()
    settings: tuple[Setting, ...] = ()
    measures: dict[str, MeasureText] = {}

    @model_validator(mode="before")
    @classmethod
    def _named(cls, content: dict[str, Any]) -> dict[str, Any]:
        settings = [{"name": name, **setting} for name, setting in content.get("settings", {}).items()]
        return {**content, "settings": settings}


def load_test(name: str, perform: Perform, why_not: WhyNot = always) -> StandardTest:
    """The test with title, standards, settings and needs of ``standard/NAME.toml``, and what it does.

    `perform`, `why_not`: see `StandardTest`.
    """
    about = _TestFile.model_validate(read_toml(_FOLDER / f"{name}.toml", HostError))
    parts = about.standards, about.settings, about.needs, about.measures
    return StandardTest(name, about.title, perform, *parts, why_not)
