"""Digest of the program that makes runs, and versions of its packages."""

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import ali3

_PACKAGES = ("ali3", "distributed", "fmpy", "numpy", "pandas", "pyarrow", "scipy", "xarray")


@cache
def program_digest() -> str:
    """A hash of the sources of the hosts and of what they share, and of the files that these read."""
    root = Path(ali3.__file__).parents[1]
    digest = hashlib.sha256()
    for package in ("ali3", "hosts"):
        files = [file for kind in ("*.py", "*.toml") for file in (root / package).rglob(kind)]
        for file in sorted(files):
            digest.update(file.relative_to(root).as_posix().encode() + b"\n" + file.read_bytes())
    return digest.hexdigest()


def version_of(package: str) -> str:
    """The version of a package, or that it is not installed, as ALi3 in a clone."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that make the runs."""
    python = {"python": platform.python_version(), "platform": platform.platform()}
    return python | {package: version_of(package) for package in _PACKAGES}
