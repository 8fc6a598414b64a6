"""From a System to an FMU file."""

from __future__ import annotations

import importlib.metadata
import re
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import mbs
from fmu_src.platforms import PLATFORMS, SUFFIXES, TARGETS
from fmu_src.python_slave.package import Contents, pack
from fmu_src.python_slave.shell_build import compile_shell
from fmu_src.variables import check_variants, variable_table
from mbs.kernel import binding, build

Say = Callable[[str], None]
_PATIENCE = 2.0


def fmu_name(scene: str) -> str:
    """Name of the FMU of a scene: ``prototype_car`` -> ``PrototypeCarPython``."""
    words = [w for w in re.split(r"[^A-Za-z0-9]+", scene) if w]
    name = "".join(w[0].upper() + w[1:] for w in words)
    if not name or not name[0].isalpha() or not name.isascii():
        raise ValueError(f"'{scene}' gives no name for an FMU; a scene's name begins with a letter from a to z.")
    return f"{name}Python"


def build_fmu(
    system: mbs.System | Sequence[mbs.System],
    name: str,
    out: Path,
    platforms: Sequence[str] = PLATFORMS,
    say: Say = lambda text: None,
    fidelity: int = 0,
) -> Path:
    """Build the FMU of a System.

    Parameters
    ----------
    system : mbs.System or sequence of them
        Several are the rungs of the parameter `fidelity`: with the same inputs, parameters and sensors.
    name : str
        Of the scene, such as ``prototype_car``.
    out : Path
        Folder; made if it is not there.
    platforms : sequence of str
        Out of ``linux64`` and ``win64``.
    say : callable
        Is told what is going on, one line at a time.
    fidelity : int
        The default among several Systems.

    Returns
    -------
    Path
        The FMU.
    """
    unknown = set(platforms) - set(PLATFORMS)
    if unknown or not platforms:
        raise ValueError(f"Platform '{', '.join(unknown)}' is not known; PythonFMU runs on {', '.join(PLATFORMS)}.")
    model_name = fmu_name(name)
    systems = [system] if isinstance(system, mbs.System) else list(system)
    check_variants([s.meta for s in systems])
    meta = systems[fidelity].meta
    experiment = meta["experiment"]
    step = float(experiment["step_s"])
    table = variable_table(
        meta, pose=bool(meta["floating"]), step_size=step, fidelities=len(systems), fidelity=fidelity
    )
    kernels, shells = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for platform in platforms:
            place = Path(folder, platform)
            place.mkdir()
            with _told(say, f"compiling for {platform}", "the first time for Windows takes two minutes"):
                kernels[platform] = build.compile_library(TARGETS[platform], place / f"kernel{SUFFIXES[platform]}")
                shells[platform] = compile_shell(platform, place)
        file = out / f"{model_name}.fmu"
        with _told(say, "packing"):
            pack(
                Contents(
                    model_name,
                    meta.get("description") or f"{name.replace('_', ' ')}, a multibody system solved by ALi3",
                    importlib.metadata.version("ali3"),
                    [s.to_bytes() for s in systems],
                    table,
                    [[row["name"] for row in s.meta["rows"]] for s in systems],
                    float(experiment["stop_time_s"]),
                    step,
                    Path(binding.__file__),
                    kernels,
                    shells,
                ),
                file,
            )
    return file


@contextmanager
def _told(say: Say, what: str, note: str = "") -> Iterator[None]:
    """Says what is going on once it takes long, and that it still goes on."""
    begin, finished = time.perf_counter(), threading.Event()

    def watch() -> None:
        wait = _PATIENCE
        while not finished.wait(wait):
            say(f"{what}: {time.perf_counter() - begin:.0f} s{f' ({note})' if note else ''} ...")
            wait = 10.0

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        finished.set()
        watcher.join()
    say(f"{what}: done in {time.perf_counter() - begin:.1f} s")
