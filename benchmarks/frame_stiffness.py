"""Torsional stiffness and frequencies of frames of cars: ``python -m benchmarks.frame_stiffness [CAR ...]``.

Opposite couples twist the free frame at the highest joint of each axle; frequencies are those of the free frame with
all that it carries.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.frame_stiffness import stiffness
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.tables import print_table
from mbs.vehicle import car_names, load


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, print, and write what was asked for."""
    parser = parser_of("frame_stiffness", __doc__)
    parser.add_argument(
        "cars", nargs="*", metavar="CAR", help="name, folder or file; default: all of the package that have a frame"
    )
    options = parser.parse_args(arguments)
    rows = []
    for name in options.cars or [n for n in car_names() if load(n).chassis.frame is not None]:
        found = stiffness(load(name))
        hertz = {f"f{k + 1}, Hz": float(f) for k, f in enumerate(found.frequencies)}
        rows.append({"car": name, "between": " and ".join(found.joints), "kN m/deg": found.torsion / 1e3, **hertz})
    print_table(rows, {"car": "", "between": "", "kN m/deg": ".2f", **dict.fromkeys(hertz, ".1f")})
    save_rows(options.json, "frame_stiffness", rows)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
