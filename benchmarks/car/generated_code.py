"""Steps of scenes by the kernel's loops and by code that was generated for their Systems, in turn."""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from benchmarks.car import step_scenes
from benchmarks.car.against_checkout import Side, row_of
from benchmarks.car.step_scenes import Scene
from benchmarks.shared.command import watched
from benchmarks.shared.pages import Row, table
from mbs.compiler.generated.library import library_of


def measure(scenes: Sequence[Scene], rounds: int, repeats: int) -> Iterator[dict[str, Any]]:
    """A row for each scene, as in `against_checkout`, and the size of the code.

    Parameters
    ----------
    scenes : sequence of Scene
        Scenes of `step_scenes.SCENES`.
    rounds : int
        Each measures both, one after the other; the ratio is the median of the ratios of all rounds.
    repeats : int
        Runs of which a round takes the least time.

    Raises
    ------
    RuntimeError
        A step is refused, or both do not make the same iterations.
    """
    with tempfile.TemporaryDirectory() as folder:
        program = step_scenes.compile_program(Path(folder))
        for scene in watched(scenes):
            yield _row(scene, program, Path(folder), rounds, repeats)


def _row(scene: Scene, program: Path, folder: Path, rounds: int, repeats: int) -> dict[str, Any]:
    system = scene.system()
    command = step_scenes.command_of(scene._replace(system=lambda: system), program, folder)
    code = library_of(system)
    two_sides = [Side("generated", command, (str(code),)), Side("loops", command)]
    row = row_of(scene, two_sides, scene.steps, rounds, repeats, counted=True)
    if row["iterations generated"] != row["iterations loops"]:
        raise RuntimeError(f"Generated code does not make the iterations of the loops in the scene {scene.name!r}.")
    return row | {"kB": round(code.stat().st_size / 1000)}


def blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Operations, instructions and time of a step, the code in kB."""
    keys_by_title = {
        "operations": "operations generated",
        "instructions, loops": "instructions loops",
        "generated": "instructions generated",
        "us, loops": "us loops",
        "us, generated": "us generated",
    }
    lines = [
        {"scene": r["scene"], "step, ms": f"{r['step, ms']:g}"}
        | {name: r.get(key) for name, key in keys_by_title.items()}
        | {"times as fast": 1.0 / r["ratio"], "code, kB": r["kB"]}
        for r in rows
    ]
    columns = {"scene": "", "step, ms": "", "operations": ",d", "instructions, loops": ",d", "generated": ",d"}
    return {
        "generated": table(
            lines, columns | {"us, loops": ".1f", "us, generated": ".1f", "times as fast": ".2f", "code, kB": "d"}
        )
    }
