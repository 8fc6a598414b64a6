"""Modules and names of a package as its attributes, imported when they are first asked for: ``mbs.vehicle.load``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from typing import Any


def lazy_modules(package: str, names: Iterable[str], homes: Mapping[str, str] | None = None) -> Callable[[str], Any]:
    """Function ``__getattr__`` of a package that imports modules when a name is first used.

    `homes`: functions, classes and others by name, with the full name of the module that each is in.
    """
    modules, sources = frozenset(names), dict(homes or {})

    def attribute(name: str) -> Any:
        if name in sources:
            return getattr(import_module(sources[name]), name)
        if name in modules:
            return import_module(f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return attribute
