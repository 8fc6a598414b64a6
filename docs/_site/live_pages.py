"""The pages of `docs/driving.md` that run FMUs, made when the site is built, and the list of them."""

import hashlib
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util import logging

ROOT = Path(__file__).parents[2]
PLACE = "live"
PAGES = {
    "proving_ground": "**The proving ground in a tab**: the prototype car with sound, from the places of its map.",
    "prototype": "**The prototype car**: keys, gamepad or levers drive it; its parameters are sliders.",
    "hatchback": "**The hatchback**, a front-driven electric car: the colours of its frame are stresses, which are "
    "computed while it is driven.",
    "double_four_bar": "**The double four-bar through its singular positions**, beside the same run of a method that "
    "fails there.",
    "puma": "**The PUMA robot**: its six torques follow a table until you move a slider.",
}
OF_ONE_FMU = ("proving_ground", "prototype")
"""Made by one program, which builds their FMU once."""
MARK = "<!-- live pages -->"
MODE = "ALI3_LIVE_PAGES"
"""Environment variable: ``required``, a page that cannot be made is an error; ``none``, no page is made."""
SOURCES = ("mbs", "fmu_src", "hosts", "viewer", "docs/_site")
SUFFIXES = {".py", ".c", ".h", ".js", ".css", ".toml", ".csv", ".json", ".mjs"}
LEFT_OUT = {"node_modules", "bundle", "__pycache__", "lib"}

logger = logging.getLogger(__name__)


def digest() -> str:
    """Of all that the pages are made from."""
    content_hash = hashlib.sha256()
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in SUFFIXES and not LEFT_OUT & set(path.parts):
                content_hash.update(f"{path.relative_to(ROOT)} {path.stat().st_size}\n".encode())
                content_hash.update(path.read_bytes())
    return content_hash.hexdigest()


def make(names: Sequence[str], out: Path) -> str:
    """Make pages in a program of their own; what went wrong in one line, or nothing."""
    command = [sys.executable, str(Path(__file__).with_name("make_live_page.py")), *names, str(out)]
    process = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    last_line = [f"exit code {process.returncode}", *process.stderr.strip().splitlines()][-1]
    return "" if process.returncode == 0 else f"{' and '.join(names)}: {last_line}"


def build(app: Sphinx) -> None:
    """Make the pages unless they are there, from the same sources."""
    app.config.live_pages = []
    mode = os.environ.get(MODE, "")
    if app.builder.format != "html" or mode == "none":
        return
    out, start_time = Path(app.outdir) / PLACE, time.monotonic()
    stamp, current_digest = out / "sources.sha256", digest()
    if not (stamp.is_file() and stamp.read_text() == current_digest):
        out.mkdir(parents=True, exist_ok=True)
        stamp.unlink(missing_ok=True)
        programs = [OF_ONE_FMU, *((name,) for name in PAGES if name not in OF_ONE_FMU)]
        with ThreadPoolExecutor(2) as pool:
            failures = [failure for failure in pool.map(lambda names: make(names, out), programs) if failure]
        if failures and mode == "required":
            raise ExtensionError(f"Pages that run FMUs could not be made: {'; '.join(failures)}")
        if failures:  # a plain line: the rest of the site is as good, also where warnings are errors
            print(f"warning: pages that run FMUs are left out of the site: {'; '.join(failures)}", file=sys.stderr)
        else:
            stamp.write_text(current_digest)
            logger.info("pages that run FMUs: %.0f s", time.monotonic() - start_time)
    app.config.live_pages = [name for name in PAGES if (out / f"{name}.html").is_file()]


def listed(app: Sphinx, page: str, source: list[str]) -> None:
    """Put the list of the pages into the document that asks for it."""
    if MARK not in source[0]:
        return
    entries = [
        f'- {PAGES[name]} <a href="{PLACE}/{name}.html">Open it</a> '
        f"({(Path(app.outdir) / PLACE / f'{name}.html').stat().st_size / 1e6:.1f} MB)."
        for name in app.config.live_pages
    ]
    absent = "This copy of the site was built without the pages; `ali3 view FMU --live` makes one."
    source[0] = source[0].replace(MARK, "\n".join(entries) or absent)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hooks."""
    app.add_config_value("live_pages", [], "env")
    app.connect("builder-inited", build)
    app.connect("source-read", listed)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
