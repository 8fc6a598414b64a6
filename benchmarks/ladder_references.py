"""Writes the references of the ladder: ``python -m benchmarks.ladder_references [NAME ...]``.

They come from this engine with the highest rung (60 static, 6 inertia and 40 dynamic modes) at a step of 0.5 ms. Each
file says how far runs with twice the step, and with 5 dynamic modes, are from it; a second file holds the peaks of all
steps.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np

from benchmarks import ladder_runs
from benchmarks.command import parser_of, watched
from benchmarks.ladder_runs import FILTERED, FOLDER, INTERVAL, LOADS, MOMENTS, NAMES, POSITION
from mbs.scenes.prototype_car.chassis import DYNAMIC, REFERENCE_MODES

STEP = 5e-4  # s


def write(name: str) -> str:
    """Run, write and return one line."""
    fine = ladder_runs.run(name, REFERENCE_MODES, STEP)
    values = ladder_runs.sampled(fine, STEP)
    checks = {
        f"step {2 * STEP:g} s": ladder_runs.sampled(ladder_runs.run(name, REFERENCE_MODES, 2 * STEP), 2 * STEP),
        "5 dynamic modes": ladder_runs.sampled(ladder_runs.run(name, DYNAMIC, STEP), STEP),
    }
    said = []
    for what, other in checks.items():
        e = ladder_runs.errors(other, values)
        said.append(
            f"{what}: moments {e['moment']:.1e} after the low-pass and {e['moment_unfiltered']:.1e} before it, "
            f"place {e['motion']:.1e} m, wheel loads {e['wheel_load']:.1e}"
        )
    signals = (*POSITION, *LOADS, *MOMENTS, *(FILTERED + s for s in MOMENTS))
    lines = [
        f"# Prototype car, flexible chassis, {name.replace('_', ' ')}: this engine, 106 modes, steps of {STEP:g} s; "
        "made by python -m benchmarks.ladder_references",
        *(f"# differences with {text}" for text in said),
        ",".join(["time", *signals]),
    ]
    t = INTERVAL * np.arange(len(values[POSITION[0]]))
    for row in np.column_stack([t, *(values[s] for s in signals)]):
        lines.append(",".join(f"{v:.7g}" for v in row))
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    _write_peaks(name, ladder_runs.peaks(fine, STEP))
    return f"{name}: " + "; ".join(said)


def _write_peaks(name: str, peaks: dict[str, float]) -> None:
    lines = [
        f"# Largest changes from the start over all steps of {STEP:g} s of {name}.csv, whose samples miss them, N m",
        "signal,largest change",
        *(f"{signal},{value:.7g}" for signal, value in peaks.items()),
    ]
    (FOLDER / f"{name}_peaks.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> int:
    """Write all references, or those named."""
    parser = parser_of("ladder_references", __doc__, json=False)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"out of: {', '.join(NAMES)}")
    options = parser.parse_args(arguments)
    unknown = set(options.names) - set(NAMES)
    if unknown:
        parser.error(f"there is no manoeuvre {', '.join(sorted(unknown))}")
    lines = [write(name) for name in watched(options.names or NAMES)]
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
