"""Writes the reference trajectories of a car: ``python -m benchmarks.car_references [--car CAR] [NAME ...]``.

They come from this engine at a step of 0.1 ms with a tight tolerance. Each file says how the runs with 1, 0.5 and
0.25 ms differ from it: the differences fall with the square of the step where nothing is discontinuous.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car import manoeuvres
from benchmarks.car.trajectories import write, write_replay
from benchmarks.shared.command import parser_of, watched


def main(arguments: Sequence[str] | None = None) -> int:
    """Write all references, or those named."""
    parser = parser_of("car_references", __doc__, json=False)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"out of: {', '.join(manoeuvres.NAMES)}")
    parser.add_argument("--keep-replay", action="store_true", help="do not drive the double lane change again")
    parser.add_argument("--car", default=manoeuvres.PROTOTYPE, choices=manoeuvres.CARS, help="default: the prototype")
    options = parser.parse_args(arguments)
    unknown = set(options.names) - set(manoeuvres.NAMES)
    if unknown:
        parser.error(f"there is no manoeuvre {', '.join(sorted(unknown))}")
    if not options.keep_replay and not options.names:
        write_replay(options.car)
    lines = [write(name, options.car) for name in watched(options.names or manoeuvres.NAMES)]
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
