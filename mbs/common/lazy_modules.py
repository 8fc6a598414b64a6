"""Modules and names of a package as its attributes, imported at first use, such as ``mbs.vehicle.load``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from typing import Any


def lazy_modules(package: str, names: Iterable[str], sources: Mapping[str, str] | None = None) -> Callable[[str], Any]:
    """Make the function ``__getattr__`` of a package that imports modules at first use.

    `names`: modules of the package; `sources`: modules of further names, by name.
    """
    modules, module_of = frozenset(names), dict(sources or {})

    def attribute(name: str) -> Any:
        if name in module_of:
            return getattr(import_module(module_of[name]), name)
        if name in modules:
            return import_module(f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return attribute
