"""What a step costs as WebAssembly: ``python -m benchmarks.wasm [--json FILE]``; beside the native library."""

from __future__ import annotations

import gzip
import statistics
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import fmpy

from ali3.running import run_command
from benchmarks.car.wasm_times import KINDS, open_hosts
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.fmu_page import resources_of
from benchmarks.shared.tables import print_table
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities

FIDELITIES = (0, 2)
INNER = 10
PLAN = {"inputs": ["steering", "throttle"], "values": [0.1, 0.3], "inner": INNER}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("wasm", "What a step of the car costs as WebAssembly.")
    parser.add_argument("--steps", type=int, default=2000, metavar="N", help="of a timed run; default: 2000")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="timed runs a round; default: 3")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="in which all hosts take turns; default: 3")
    options = parser.parse_args(arguments)
    if min(options.steps, options.repeats, options.rounds) < 1 or options.steps % INNER:
        parser.error(f"numbers of steps, repeats and rounds are positive, that of steps a multiple of {INNER}")
    rows: list[dict[str, Any]] = []
    name, systems, _ = load_fidelities("prototype_car")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, ExitStack() as stack:
        fmu = build_fmu(systems, name, folder, [fmpy.platform, "wasm32"], kind="native")
        h = float(fmpy.read_model_description(str(fmu)).defaultExperiment.stepSize)
        hosts, versions = open_hosts(fmu, Path(folder, "unpacked"), stack)
        found: dict[tuple[int, str, str], list[float]] = {}
        for fidelity in watched(FIDELITIES):
            steps = options.steps if fidelity == 0 else max(INNER, options.steps // (2 * INNER) * INNER)
            start = {"initial.speed": 15.0, "fidelity": fidelity}
            plan = {**PLAN, "h": h, "start": start, "steps": steps, "warmUp": 1, "repeats": options.repeats}
            ends = set()
            for _ in range(options.rounds):
                for host, measure in hosts.items():
                    times = measure(plan)
                    ends.add(times.pop("end"))
                    for kind, values in times.items():
                        found.setdefault((fidelity, kind, host), []).extend(values)
            if len(ends) != 1:
                raise RuntimeError(f"The hosts do not end at the same place: {sorted(ends)}.")
        wasm, _ = resources_of(fmu)
    rows = [_row(key, values, found, h) for key, values in found.items()]
    print_table(
        rows, {"fidelity": "", "what": "", "host": "", "us": ".4g", "best_us": ".4g", "ratio": ".3g", "x": ".3g"}
    )
    print("\nus: median of an inner step; ratio: best over that of the native library; x: times real time")
    sizes = {"bytes": len(wasm), "gzip": len(gzip.compress(wasm, 9, mtime=0))}
    print(f"module: {sizes['bytes'] / 1e3:.0f} kB, {sizes['gzip'] / 1e3:.0f} kB gzipped")
    print("hosts: " + ", ".join(f"{host} {version}" for host, version in versions.items()))
    save_rows(
        options.json,
        "wasm",
        rows,
        repeats=options.repeats * options.rounds,
        warm_up=1,
        rounds=options.rounds,
        steps=options.steps,
        kinds=KINDS,
        step_s=h,
        module=sizes,
        hosts=versions,
    )
    return 0


def _row(
    key: tuple[int, str, str], values: Sequence[float], found: Mapping[tuple[int, str, str], Sequence[float]], h: float
) -> dict[str, Any]:
    fidelity, kind, host = key
    us = statistics.median(values)
    return {
        "fidelity": str(fidelity),
        "what": KINDS[kind],
        "host": host,
        "us": us,
        "best_us": min(values),
        "ratio": min(values) / min(found[fidelity, kind, "native"]),
        "x": 1e6 * h / us,
    }


if __name__ == "__main__":
    sys.exit(run_command(main))
