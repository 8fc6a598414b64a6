"""Finds the extra of the installation that contains a package, from the metadata of the installed distribution."""

import re
import sys
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from itertools import takewhile
from traceback import walk_tb
from types import TracebackType

_DISTRIBUTIONS = {"pil": "pillow", "sdl2": "pysdl2"}
"""Distributions by module in small letters, if the names differ."""

_extra: str | None = None


def missing_package(package: str, extra: str = "") -> str:
    """Message about a package that is not installed, with the command that installs it.

    `package`: its module, as in ``import``; `extra`: the extra to name if several contain the package and the running
    command needs none of them.
    """
    return f"The package {package} is not installed; {_install_advice(_extra_with(package, extra))}"


def missing_module(error: ModuleNotFoundError, extra: str = "") -> str:
    """Message about a module that was not found, also if a library imports it at run time.

    `extra`: see `missing_package`. Raises `error` again if neither an extra nor a package of an extra requires the
    module: an error of the program.
    """
    package = (error.name or "").partition(".")[0]
    if _extra_with(package, extra) is not None:
        return missing_package(package, extra)
    for library in _importing_libraries(error.__traceback__):
        if _extra_with(library) is None:
            continue
        is_required = _distribution(package) in map(_requirement_name, _requirements(library))
        advice = _install_advice(_extra_with(library, extra), _distribution(package) if is_required else "")
        return f"The package {library} needs {package}, which is not installed; {advice}"
    raise error


def command_needs(extra: str) -> None:
    """Store the extra of the running command."""
    global _extra
    _extra = extra


def extras() -> dict[str, set[str]]:
    """Distributions that each extra of the installation requires; distributions of no extra under ``""``."""
    results: dict[str, set[str]] = {}
    for requirement in _requirements("ali3"):
        match = re.search(r"""extra == ['"]([\w.-]+)['"]""", requirement)
        results.setdefault(match[1] if match else "", set()).add(_requirement_name(requirement))
    return results


def _extra_with(package: str, preferred_extra: str = "") -> str | None:
    """Extra of the running command, the preferred one, or the smallest with the package; None if there is none."""
    candidates = {extra: names for extra, names in extras().items() if _distribution(package) in names}
    preferred = next((extra for extra in (_extra, preferred_extra) if extra in candidates), None)
    return min(candidates, key=lambda extra: len(candidates[extra]), default=None) if preferred is None else preferred


def _importing_libraries(traceback: TracebackType | None) -> list[str]:
    """Libraries on the stack when a module was not found, the importing one first."""
    names = [frame.f_globals.get("__name__", "").partition(".")[0] for frame, _ in walk_tb(traceback)]
    installed = {name for name, owners in packages_distributions().items() if "ali3" not in owners}
    return list(takewhile(installed.__contains__, (n for n in reversed(names) if n not in sys.stdlib_module_names)))


def _requirements(distribution: str) -> list[str]:
    try:
        return requires(distribution) or []
    except PackageNotFoundError:
        return []


def _requirement_name(requirement: str) -> str:
    return _distribution(re.split(r"[^\w.-]", requirement, maxsplit=1)[0])


def _distribution(package: str) -> str:
    name = re.sub(r"[-_.]+", "-", package).lower()
    return _DISTRIBUTIONS.get(name, name)


def _install_advice(extra: str | None, packages: str = "") -> str:
    label = f'"ali3[{extra}]"' if extra else "ali3"
    return f"run: python -m pip install {label} {packages}".rstrip()
