"""Modules of a package as its attributes without an import of their own: ``mbs.vehicle.load`` after ``import mbs``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from types import ModuleType


def lazy_modules(package: str, names: Iterable[str]) -> Callable[[str], ModuleType]:
    """What a package takes as its ``__getattr__``.

    Parameters
    ----------
    package : str
        Its full name.
    names : iterable of str
        Its modules that are imported when they are first asked for.
    """
    known = frozenset(names)

    def module(name: str) -> ModuleType:
        if name not in known:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return import_module(f"{package}.{name}")

    return module
