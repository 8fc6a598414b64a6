"""Every public function and method says its parameters, with units and shapes, and what it returns and raises: the
reference pages are made of this.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from typing import Any

import mbs.scenes

ROOMS = ("mbs", "mbs.model", "mbs.elements", "mbs.flexible", "mbs.simulation")
SECTION = re.compile(r"^(Parameters|Returns|Raises|Warns|Attributes|Examples)\n-+$", re.MULTILINE)


def _names() -> Iterator[tuple[str, Any]]:
    """What the rooms export, and how each scene is built."""
    for room in ROOMS:
        module = importlib.import_module(room)
        for name in module.__all__:
            yield f"{room}.{name}", getattr(module, name)
    for scene in pkgutil.iter_modules(mbs.scenes.__path__):
        module = importlib.import_module(f"mbs.scenes.{scene.name}")
        yield f"mbs.scenes.{scene.name}.build", module.build


def _functions() -> dict[str, Any]:
    """Public functions and methods, each once."""
    found: dict[Any, str] = {}
    for name, thing in _names():
        if inspect.isfunction(thing):
            found.setdefault(thing, name)
        elif inspect.isclass(thing) and thing.__module__.startswith("mbs"):
            for method, given in inspect.getmembers(thing):
                function = getattr(given, "__func__", given)
                public = inspect.isfunction(function) and not method.startswith("_")
                if public and function.__module__.startswith("mbs"):
                    found.setdefault(function, f"{name}.{method}")
    return {name: function for function, name in found.items()}


FUNCTIONS = _functions()


def _documented(text: str) -> set[str]:
    """Names of the parameters that a docstring describes."""
    if "Parameters\n----------\n" not in text:
        return set()
    section = SECTION.split(text.split("Parameters\n----------\n", 1)[1])[0]
    heads = [line.split(" :")[0] for line in section.splitlines() if line and not line.startswith(" ")]
    return {name.strip().lstrip("*") for head in heads for name in head.split(",")}


def _parameters(function: Any) -> list[str]:
    return [p for p in inspect.signature(function).parameters if p not in ("self", "cls")]


def test_all_parameters_are_described():
    wrong = []
    for name, function in FUNCTIONS.items():
        described = _documented(inspect.getdoc(function) or "")
        if described != set(_parameters(function)):
            wrong.append(f"{name} describes {sorted(described)}")
    assert not wrong, "\n".join(wrong)


def test_what_is_returned_is_described():
    wrong = []
    for name, function in FUNCTIONS.items():
        gives = str(inspect.signature(function).return_annotation) not in ("None", "NoReturn")
        if _parameters(function) and gives and "Returns\n-------\n" not in (inspect.getdoc(function) or ""):
            wrong.append(name)
    assert not wrong, "\n".join(wrong)


def test_there_are_as_many_as_there_were():
    assert len(FUNCTIONS) > 150
