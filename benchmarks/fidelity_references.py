"""Writes the references of the comparison of fidelities: ``python -m benchmarks.fidelity_references [NAME ...]``.

They come from this engine with the most modes (60 static, 6 inertia and 40 dynamic modes) at a step of 0.5 ms. Each
file says how far runs with twice the step, and with 5 dynamic modes, are from it; a second file holds the peaks of all
steps.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.fidelity_references import write
from benchmarks.car.fidelity_runs import NAMES
from benchmarks.shared.command import parser_of, watched


def main(arguments: Sequence[str] | None = None) -> int:
    """Write all references, or those named."""
    parser = parser_of("fidelity_references", __doc__, json=False)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"out of: {', '.join(NAMES)}")
    options = parser.parse_args(arguments)
    unknown = set(options.names) - set(NAMES)
    if unknown:
        parser.error(f"there is no manoeuvre {', '.join(sorted(unknown))}")
    lines = [write(name) for name in watched(options.names or NAMES)]
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
