"""Playwright functions that the content security policy of pages blocks: waits, pictures without instruments."""

import gc
import io
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from viewer.browser import VARIABLE, BrowserError, find_chromium, launch_arguments
from viewer.bundle import HERE, bundle

PAGE = HERE / "page"


def chromium_or_skip() -> Path:
    """A Chromium of this machine. `.ci/run` installs one where it may; elsewhere the test is skipped and says why.

    A program that the environment names and that is not there is a mistake, and no reason to skip.
    """
    try:
        return find_chromium()
    except BrowserError as error:
        if os.environ.get(VARIABLE):
            raise
        pytest.skip(str(error))


# Not drawn: two pages behind the address bar of each window, as dear as ours, and what Skia draws by shaders,
# as Debian asks for. The list of features replaces that of playwright, of which pictures need the last two.
_LESS_AROUND = (
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup,PaintHolding,HttpsUpgrades",
    "--disable-gpu-rasterization",
)
SELDOM = """{
  const soon = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 80);
}"""
"""For `add_init_script`: a page that draws twelve times a second at most, as the processor does."""
WITHOUT_WEBGL = """{
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return /webgl/.test(kind) ? null : get.call(this, kind, ...more);
  };
}"""
"""For `add_init_script`."""
AXE = Path(os.environ.get("ALI3_AXE", PAGE / "node_modules" / "axe-core" / "axe.min.js"))
with_axe = pytest.mark.skipif(not AXE.is_file(), reason="axe-core is not installed: npm --prefix viewer/page ci")
_FINDINGS = """async () => (await axe.run(document, { resultTypes: ['violations'] })).violations
  .map(({ id, nodes }) => `${id}: ${nodes.length}, such as ${nodes[0].html.slice(0, 120)}`)"""


def axe_findings(page: Any) -> list[str]:
    """What axe-core finds in a page of playwright, a line for each rule."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    result: list[str] = page.evaluate(_FINDINGS)
    return result


@contextmanager
def headless_chromium() -> Iterator[Any]:
    """A Chromium without a window, started by playwright; the test is skipped where one of them is not there."""
    play = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    program = chromium_or_skip()
    gc.collect()  # an error of another test may hold a browser of its own, beside which there can be no second
    with play.sync_playwright() as started:
        arguments = ["--headless=new", *launch_arguments(), *_LESS_AROUND]
        browser = started.chromium.launch(executable_path=program, args=arguments, timeout=60_000)
        yield browser
        browser.close()


def bundle_or_skip() -> Path:
    """The script of the pages; the test is skipped where it cannot be built."""
    try:
        return bundle()
    except RuntimeError as error:
        pytest.skip(str(error))


def wait_until(page: Any, expression: str, arg: Any = None, timeout: float = 120.0) -> Any:
    """The value of an expression, or of a function of `arg`, once it is true.

    Parameters
    ----------
    page : playwright Page or Frame
    expression : str
    arg : object, optional
    timeout : float
        s.
    """
    if arg is None:  # objects of the page stay there
        expression = f"(() => {{ const it = ({expression}); return typeof it === 'object' ? it !== null : it; }})()"
    return wait_for(page, lambda: _evaluated(page, expression, arg), expression, timeout)


def wait_for(page: Any, holds: Callable[[], Any], what: object, timeout: float = 120.0) -> Any:
    """What a function gives, once it is true; `what` it waits for is said where that is not within `timeout` s."""
    end = time.monotonic() + timeout
    while not (value := holds()):
        assert time.monotonic() < end, f"not within {timeout:g} s: {what() if callable(what) else what}"
        page.wait_for_timeout(20)
    return value


def wait_text(page: Any, element: str, message: str) -> None:
    """An element, by its name for programs, has these words: a picture comes later than what it shows."""
    text = page.locator(f'[data-a3="{element}"]').first.text_content
    wait_for(page, lambda: message in text(), lambda: f"'{message}' in '{element}', which says '{text()}'")


def wait_drawn(page: Any) -> None:
    """The simulator has drawn what its page knows now; figures come after the picture."""
    wait_until(page, "now => player.cockpit._timed > now", arg=page.evaluate("performance.now() / 1000"))


def _evaluated(page: Any, expression: str, arg: Any) -> Any:
    """The value of an expression; None while the page goes to another address."""
    from playwright.sync_api import Error

    try:
        return page.evaluate(expression, arg)
    except Error as error:
        if "because of a navigation" not in str(error):
            raise
        return None


def picture_of_simulator(page: Any) -> np.ndarray:
    """Pixels of the page of the simulator (height, width, 3), without instruments."""
    page.evaluate(
        """() => {
          window.hiding = new CSSStyleSheet();
          hiding.replaceSync(
            ".a3-sim .a3-views > :not(.a3-view):not(.a3-map), .a3-sim .a3-foot { visibility: hidden }"
          );
          document.adoptedStyleSheets = [...document.adoptedStyleSheets, hiding];
        }"""
    )
    shot = page.screenshot()
    page.evaluate("document.adoptedStyleSheets = document.adoptedStyleSheets.filter((sheet) => sheet !== hiding)")
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
