"""What an FMU costs: ``python -m benchmarks.fmu [--json FILE]``; the native one against PythonFMU, from C and FMPy.

With ``--road-ports`` what the answers of another program at the four road ports of the prototype add to a step through
FMPy, in instructions, with the answers computed in Python.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import fmpy

from ali3.running import run_command
from benchmarks.car import road_port_cost, road_port_steps
from benchmarks.car.fmu_calls import QUANTITIES, measure
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene

KINDS = ("native", "python")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("fmu", "What an FMU costs.")
    parser.add_argument("--scene", default="prototype_car", metavar="NAME", help="default: prototype_car")
    parser.add_argument("--steps", type=int, default=1000, metavar="N", help="calls per timed run; default: 1000")
    parser.add_argument("--repeats", type=int, default=5, metavar="N", help="timed runs per figure; default: 5")
    parser.add_argument("--instances", type=int, default=1000, metavar="N", help="at once; default: 1000")
    parser.add_argument("--road-ports", action="store_true", help="instructions of steps with four road ports")
    options = parser.parse_args(arguments)
    if min(options.steps, options.repeats, options.instances) < 1 or options.repeats > 64:
        parser.error("numbers of steps, repeats and instances are positive, repeats at most 64")
    if options.road_ports:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            found = road_port_cost.measure("prototype", min(options.steps, 500), Path(folder))
        print_table(found, road_port_cost.COLUMNS)
        save_rows(options.json, "road_ports", found, step_s=road_port_steps.STEP)
        return 0
    rows = []
    name, system = load_scene(options.scene)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        for kind in watched(list(KINDS)):
            fmu = build_fmu(system, name, Path(folder), [fmpy.platform], kind=kind)
            rows += measure(fmu, kind, Path(folder, kind), options.steps, options.repeats, options.instances)
    table = [
        {
            "quantity": quantity,
            **{f"{k}, {h}": _value(rows, quantity, k, h) for k in KINDS for h in ("C", "FMPy")},
            "meaning": words,
        }
        for quantity, words in (QUANTITIES | {"file_MB": "size of the file with the binary of one platform"}).items()
    ]
    columns = {"quantity": "", **{f"{k}, {h}": ".4g" for k in KINDS for h in ("C", "FMPy")}, "meaning": ""}
    print_table(table, columns)
    save_rows(
        options.json,
        "fmu",
        rows,
        scene=options.scene,
        steps=options.steps,
        repeats=options.repeats,
        warm_up=1,
        instances=options.instances,
        quantities=QUANTITIES,
        inner_step_s=system.meta["experiment"]["step_s"],
    )
    return 0


def _value(rows: Sequence[dict[str, str | float | None]], quantity: str, kind: str, host: str) -> float | None:
    for row in rows:
        if (row["quantity"], row["kind"], row["host"]) == (quantity, kind, host):
            value = row["value"]
            return float(value) if value is not None else None
    return None


if __name__ == "__main__":
    sys.exit(run_command(main, (RuntimeError,)))
