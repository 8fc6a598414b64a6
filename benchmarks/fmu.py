"""Cost of FMUs: ``python -m benchmarks.fmu PART``: calls, WebAssembly, cars in Python, studies of many runs."""

import sys
import tempfile
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import fmpy

from benchmarks.car import fmu_calls, held_inputs, manoeuvres, wasm_times
from benchmarks.methods import studies
from benchmarks.shared.command import Part, run, watched
from benchmarks.shared.pages import Row
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene


def _calls(options: Namespace) -> list[dict[str, Any]]:
    name, system = load_scene(options.scene)
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        for kind in watched(fmu_calls.KINDS):
            fmu = build_fmu(system, name, Path(folder), [fmpy.platform], kind=kind)
            counts = options.steps, min(options.repeats, 64), options.instances
            rows += fmu_calls.measure(fmu, kind, Path(folder, kind), *counts)
    return rows


def _held(options: Namespace) -> list[dict[str, Any]]:
    system = manoeuvres.system_of("drop")
    kinds = dict.fromkeys(kind for kind, *_ in held_inputs.INTERPOLATIONS.values())
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        fmus = {kind: build_fmu(system, "car", Path(folder), [fmpy.platform], kind=kind) for kind in watched([*kinds])}
        return held_inputs.measure(fmus, options.only)


def _plant(options: Namespace) -> list[dict[str, Any]]:
    from benchmarks.car import plant_steps  # needs the extra `learn`

    counts = options.several, options.repeats, options.steps
    return [row for name in watched(plant_steps.ENVIRONMENTS) for row in plant_steps.measure(name, *counts)]


def _plant_blocks(rows: Sequence[Row]) -> dict[str, str]:
    from benchmarks.car import plant_steps

    return plant_steps.plant_blocks(rows)


PARTS = {
    "calls": Part(
        "calls of the native FMU and of the FMU of PythonFMU, from C",
        _calls,
        options={
            "scene": ("prototype_car", "car or scene, as for ali3 build"),
            "steps": (1000, "calls of a timed run"),
            "repeats": (5, "timed runs of a figure, at most 64"),
            "instances": (1000, "at once"),
        },
        pages=("fmu_hosts.md",),
        blocks=fmu_calls.fmu_blocks,
    ),
    "wasm": Part(
        "a step of the prototype as WebAssembly in each host, beside the native library",
        lambda options: wasm_times.measure(options.steps, options.repeats, options.rounds),
        options={
            "steps": (2000, "of a timed run"),
            "repeats": (3, "timed runs a round"),
            "rounds": (3, "in which all hosts take turns"),
        },
        pages=("fmu_hosts.md",),
        blocks=wasm_times.wasm_blocks,
    ),
    "plant": Part(
        "steps per second of a car in Python and of its environments, beside bare FMPy (extra `learn`)",
        _plant,
        options={
            "several": (8, "environments together"),
            "repeats": (30, "times that each way makes the steps"),
            "steps": (20, "steps"),
        },
        pages=("stepping.md",),
        blocks=_plant_blocks,
    ),
    "held": Part(
        "errors over the communication step: inputs held, on derivatives, asked for within steps",
        _held,
        names=held_inputs.MANOEUVRES,
        pages=("fmu_hosts.md",),
        blocks=held_inputs.blocks,
        chart=held_inputs.draw,
    ),
    "study": Part(
        "what Dask takes beside runs of about 0.1 s; memory and disk as runs grow in number (extra `study`)",
        studies.measure,
        names=studies.PARTS,
        options=studies.OPTIONS,
        pages=("scale.md",),
        blocks=studies.study_blocks,
    ),
}

main = partial(run, "fmu", __doc__, PARTS)

if __name__ == "__main__":
    sys.exit(main())
