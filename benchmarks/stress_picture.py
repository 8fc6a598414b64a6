"""The frame in the kerb test, deformed and coloured by stress: ``python -m benchmarks.stress_picture [--out DIR]``.

Runs the scene kerb_test and draws the moment of the largest stress as PNG and the fall from the kerb as GIF:
the largest normal stress round each tube, with the deformation scaled up. Needs PyVista, an extra:
``pip install "ali3[pictures]"``; without it the picture is made by Matplotlib, without animation.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command
from benchmarks.car.stress_picture import amplitudes, draw, draw_plain, motion_of
from benchmarks.shared.command import parser_of
from mbs.scenes import prototype_car
from mbs.vehicle import Fidelity


def main(arguments: Sequence[str] | None = None) -> int:
    """Run, draw, say where."""
    parser = parser_of("stress_picture", __doc__, json=False)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    parser.add_argument("--plain", action="store_true", help="draw with Matplotlib")
    options = parser.parse_args(arguments)
    frame, _ = prototype_car.car().tubular_frame.frame()
    body = prototype_car.car().flexible_frame.reduced(Fidelity.DYNAMIC)
    motion = motion_of(frame, body, *amplitudes(body))
    options.out.mkdir(parents=True, exist_ok=True)
    plain = options.plain or importlib.util.find_spec("pyvista") is None
    files = (draw_plain if plain else draw)(frame, motion, options.out)
    rest, peak = motion.stress[0].max() / 1e6, motion.stress.max() / 1e6
    print(f"largest normal stress {rest:.1f} MPa at rest, {peak:.1f} MPa in the test")
    if plain and not options.plain:
        print('PyVista is not installed: no animation; run: pip install "ali3[pictures]"')
    print(f"written: {', '.join(map(str, files))}")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
