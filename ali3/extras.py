"""Finds the extra of the installation that contains a package, from the metadata of the installed distribution."""

import re
import sys
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from itertools import takewhile
from traceback import walk_tb
from types import TracebackType

_DISTRIBUTIONS = {"pil": "pillow", "sdl2": "pysdl2"}
"""Distributions that are not named as the module they bring."""

_extra: str | None = None


def missing_package(package: str, extra: str = "") -> str:
    """The sentence for a package that is not installed, with the line that installs it.

    `package`: its module, as in ``import``; `extra`: named where several extras bring the package and the command that
    runs needs none of them.
    """
    return f"The package {package} is not installed; {_install(_extra_of(package, extra))}"


def missing_module(error: ModuleNotFoundError, extra: str = "") -> str:
    """The sentence for a module that was not found, also when a library asked for it at run time.

    `error`: as it was caught; `extra`: as of `missing_package`. Raises `ModuleNotFoundError`: the same, where neither
    an extra nor a package of an extra asks for the module: a mistake in code.
    """
    package = (error.name or "").partition(".")[0]
    if _extra_of(package, extra) is not None:
        return missing_package(package, extra)
    for library in _askers(error.__traceback__):
        if _extra_of(library) is None:
            continue
        optional = _distribution(package) in map(_name, _requirements(library))
        line = _install(_extra_of(library, extra), _distribution(package) if optional else "")
        return f"The package {library} needs {package}, which is not installed; {line}"
    raise error


def command_needs(extra: str) -> None:
    """Take over the extra of the command that runs."""
    global _extra
    _extra = extra


def extras() -> dict[str, set[str]]:
    """Distributions that each extra of the installation asks for; what is needed without an extra under ``""``."""
    results: dict[str, set[str]] = {}
    for requirement in _requirements("ali3"):
        marked = re.search(r"""extra == ['"]([\w.-]+)['"]""", requirement)
        results.setdefault(marked[1] if marked else "", set()).add(_name(requirement))
    return results


def _extra_of(package: str, wanted: str = "") -> str | None:
    """The extra of the command that runs, the wanted one, or the smallest; None: no extra brings the package."""
    providing = {extra: names for extra, names in extras().items() if _distribution(package) in names}
    preferred = next((extra for extra in (_extra, wanted) if extra in providing), None)
    return min(providing, key=lambda extra: len(providing[extra]), default=None) if preferred is None else preferred


def _askers(place: TracebackType | None) -> list[str]:
    """Libraries that were at work when a module was not found, the one that asked for it first."""
    names = [frame.f_globals.get("__name__", "").partition(".")[0] for frame, _ in walk_tb(place)]
    installed = {name for name, of in packages_distributions().items() if "ali3" not in of}
    return list(takewhile(installed.__contains__, (n for n in reversed(names) if n not in sys.stdlib_module_names)))


def _requirements(distribution: str) -> list[str]:
    try:
        return requires(distribution) or []
    except PackageNotFoundError:
        return []


def _name(requirement: str) -> str:
    return _distribution(re.split(r"[^\w.-]", requirement, maxsplit=1)[0])


def _distribution(package: str) -> str:
    name = re.sub(r"[-_.]+", "-", package).lower()
    return _DISTRIBUTIONS.get(name, name)


def _install(extra: str | None, more: str = "") -> str:
    label = f'"ali3[{extra}]"' if extra else "ali3"
    return f"run: python -m pip install {label} {more}".rstrip()
