"""Whether a run reports that it is wrong: ``python -m benchmarks.honesty [--json FILE] [--quick]``,
or of random mechanisms and cars or machines ``--random N --seed S [--family machines] [--before FILE]``.

Every scene, method and manoeuvre of the car at coarse and fine steps, as `mbs.simulate` runs it: the true error beside
its estimate. A run is wrong when a judged sensor is off by more than 5 % of the largest range in its unit at one of
51 instants; a warning then is right, and is a false alarm elsewhere.

With --random, N mechanisms and a car for every ten: each in equal steps and under a tolerance (wrong: beyond ten
of it), against Newton and Euler's equations under DOP853, of cars against another method. With --family machines N
belts, brakes, plays, cams, impacts and stops, against their equations under DOP853.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.methods import random_honesty
from benchmarks.methods.honesty import SUMMARY, measure, summary
from benchmarks.methods.honesty_scenes import SCENES
from benchmarks.methods.kernel_methods import TITLES
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table

LONG = 12.0  # s of processor time beyond which a method is not run with a finer step
QUICK = {"pendulum": (0.2, 0.05, 0.01), "printed_crank_slider": (1e-3, 2e-5), "tumbling_body": (0.01, 0.0002)}
TABLE = {
    "scene": "",
    "method": "",
    "h_s": ".4g",
    "ended": "",
    "error": ".1e",
    "estimate": ".1e",
    "balance": ".1e",
    "halvings_per_step": ".2g",
    "repeated": "",
    "verdict": "",
    "cpu_s": ".2g",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("honesty", __doc__)
    parser.add_argument("--scene", action="append", choices=list(SCENES), help="a scene; may be given again")
    parser.add_argument("--method", action="append", choices=list(TITLES), help="a method; may be given again")
    parser.add_argument("--quick", action="store_true", help="three scenes, the default method, a few steps")
    parser.add_argument("--longest", type=float, default=LONG, metavar="S", help="of a run, before finer steps stop")
    parser.add_argument("--random", type=int, metavar="N", help="so many random mechanisms and cars instead")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of --random; 1 if not given")
    parser.add_argument("--family", choices=random_honesty.FAMILIES, default="mechanisms", help="of --random")
    parser.add_argument("--before", type=Path, metavar="FILE", help="rows of --random to compare costs with")
    options = parser.parse_args(arguments)
    if options.random is not None:
        return _random(options.random, options.seed, options.family, options.before, options.json)
    rows: list[dict[str, Any]] = []
    for name in watched(options.scene or list(QUICK if options.quick else SCENES)):
        methods = ["ali3p"] if options.quick else SCENES[name].methods()
        for method in [m for m in methods if not options.method or m in options.method]:
            for h in QUICK[name] if options.quick else SCENES[name].steps:
                rows.append(measure(name, method, h))
                if rows[-1]["cpu_s"] > options.longest:
                    break
    print_table(rows, TABLE)
    lines = summary(rows)
    print()
    print_table(lines, SUMMARY)
    save_rows(options.json, "honesty", rows, summary=lines)
    return 0


def _random(count: int, seed: int, family: str, before: Path | None, file: Path | None) -> int:
    rows = list(random_honesty.rows_of(seed, watched(range(count)), family))
    old = json.loads(before.read_text(encoding="utf-8"))["rows"] if before is not None else []
    bad = [r for r in rows if r["verdict"] in random_honesty.TOLD]
    if bad:
        print_table(bad, random_honesty.TABLE)
        print()
    lines = random_honesty.summary(rows, old)
    print_table(lines, random_honesty.SUMMARY)
    print(f"\n{sum(r['verdict'] == 'none' for r in rows)} without a reference: two runs of it did not agree.")
    save_rows(file, "honesty", rows, seed=seed, family=family, summary=lines)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
