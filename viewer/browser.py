"""Takes pictures of a page with a headless Chromium."""

from __future__ import annotations

import os
import shutil
from collections.abc import Generator, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.errors import UserError
from ali3.extras import missing_package

if TYPE_CHECKING:
    from playwright.sync_api import Page

VARIABLE = "ALI3_BROWSER"
_NAMES = (
    *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "chrome-headless-shell"),
    *("microsoft-edge", "microsoft-edge-stable", "msedge", "brave-browser"),
)
_PATHS = (
    "/usr/lib/chromium/chromium",
    "/snap/bin/chromium",
    "/opt/google/chrome/chrome",
    "/opt/microsoft/msedge/msedge",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
)
_WINDOWS_PATHS = (
    r"Google\Chrome\Application\chrome.exe",
    r"Chromium\Application\chrome.exe",
    r"Microsoft\Edge\Application\msedge.exe",
)
# Drawing on the processor gives the same picture on every machine.
_ARGUMENTS = (
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--force-color-profile=srgb",
)


class BrowserError(UserError, RuntimeError):
    """No browser is installed, or it fails; the message gives the remedy."""


def find_chromium() -> Path:
    """A Chromium, Chrome or Edge of this machine.

    The environment variable ``ALI3_BROWSER`` names one; otherwise it is looked for on the search path and in the
    usual places of Linux, macOS and Windows.

    Raises
    ------
    BrowserError
        There is none, or the variable does not name a program.
    """
    program = os.environ.get(VARIABLE)
    if program:
        path = shutil.which(program)
        if path is None:
            raise BrowserError(f"The environment variable {VARIABLE} names {program}, which is not a program.")
        return Path(path)
    for name in _NAMES:
        path = shutil.which(name)
        if path is not None:
            return Path(path)
    for candidate in _usual_paths():
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return candidate
    raise BrowserError(
        "There is no Chromium, Chrome or Edge on this machine, which pictures need; install one, or name its program "
        f"in the environment variable {VARIABLE}."
    )


def screenshot(
    page: str | os.PathLike[str], times: Iterable[float], size: tuple[int, int] = (1280, 720), camera: str | None = None
) -> Generator[bytes, None, None]:
    """Pictures of a page that `viewer.page_file.write_page` wrote, one after the other.

    Parameters
    ----------
    page : path
        The HTML file; with the option ``controls`` false there is the drawing only.
    times : iterable of float
        Times of the pictures, s.
    size : (int, int)
        Width and height, pixels.
    camera : str, optional
        Name of a camera; by default the one that the page starts with.

    Yields
    ------
    bytes
        A PNG file.

    Raises
    ------
    BrowserError
        A browser or the package playwright is not installed, or the page cannot be drawn.
    """
    file = Path(page)
    if not file.is_file():
        raise BrowserError(f"There is no page {page}.")
    width, height = size
    if not (16 <= width <= 8192 and 16 <= height <= 8192):
        raise BrowserError(f"The picture has {width} x {height} pixels; each side must be from 16 to 8192.")
    executable = find_chromium()
    try:
        from playwright.sync_api import Error, sync_playwright
    except ModuleNotFoundError:
        raise BrowserError(missing_package("playwright")) from None
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(executable_path=executable, args=launch_arguments(), timeout=60_000)
        except Error as error:
            reason = str(error).strip().splitlines()[0]
            raise BrowserError(f"{executable} does not start: {reason}") from None
        try:
            view = browser.new_page(viewport={"width": width, "height": height})
            view.set_default_timeout(120_000)
            yield from _pictures(view, file, times, camera)
        except Error as error:
            reason = str(error).strip().splitlines()[0]
            raise BrowserError(f"{page} cannot be drawn by {executable}: {reason}") from None
        finally:
            browser.close()


def launch_arguments() -> list[str]:
    """Arguments of a Chromium that takes pictures; as root it has no sandbox."""
    is_root = hasattr(os, "geteuid") and os.geteuid() == 0
    return [*_ARGUMENTS, *(["--no-sandbox"] if is_root else [])]


def _usual_paths() -> Iterator[Path]:
    yield from map(Path, _PATHS)
    for folder in ("PROGRAMFILES", "PROGRAMFILES(X86)", "LOCALAPPDATA"):
        if os.environ.get(folder):
            yield from (Path(os.environ[folder], *path.split("\\")) for path in _WINDOWS_PATHS)


def _pictures(view: Page, file: Path, times: Iterable[float], camera: str | None) -> Iterator[bytes]:
    view.goto(file.resolve().as_uri())
    problem = view.evaluate(
        "async () => { if (!window.player) return document.body.innerText;"
        " await window.player.ready; return window.player.problem || ''; }"
    )
    if problem:
        raise BrowserError(f"{file} cannot be drawn: {problem}")
    if camera is not None:
        fault = view.evaluate("name => window.player.camera(name)", camera)
        if fault:
            raise BrowserError(str(fault))
    for time in times:
        view.evaluate("t => window.player.seek(t)", float(time))
        yield view.screenshot(animations="disabled")
