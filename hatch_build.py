"""Build hook: compiles the C kernel with the compiler of the `ziglang` package and tags the wheel for this platform."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packaging.tags import sys_tags

_OLDEST = {
    "x86_64-linux-gnu.2.17": "manylinux_2_17_x86_64",
    "aarch64-linux-gnu.2.17": "manylinux_2_17_aarch64",
    "x86_64-macos.10.13": "macosx_10_13_x86_64",
    "aarch64-macos.11.0": "macosx_11_0_arm64",
}


class KernelBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the shared library into `mbs/kernel/lib`, where wheels and editable installations find it."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before the files are collected; a source distribution carries sources only."""
        if self.target_name != "wheel":
            return
        kernel = _kernel_build_module(Path(self.root))
        library = kernel.compile_library()
        self.app.display_info(f"kernel compiled: {library}")
        # ctypes, no Python ABI: one wheel per platform serves every Python.
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{_platform_tag(kernel.host_target())}"


def _kernel_build_module(root: Path) -> ModuleType:
    """`mbs/kernel/build.py` by its path: `mbs` itself needs numpy, which a build environment does not have."""
    path = root / "mbs" / "kernel" / "build.py"
    spec = importlib.util.spec_from_file_location("ali3_kernel_build", path)
    if spec is None or spec.loader is None or not path.is_file():
        raise FileNotFoundError(f"{path} is missing: the kernel cannot be compiled.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _platform_tag(target: str) -> str:
    """Tag of the oldest system that the compiler's target runs on; that of this machine if it is none of these."""
    known = [tag.platform for tag in sys_tags()]
    oldest = _OLDEST.get(target)
    if oldest in known:
        return oldest
    return next(name for name in known if not name.startswith(("manylinux", "musllinux")))
