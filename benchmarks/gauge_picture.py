"""Draws the frame of a car with its gauges: ``python -m benchmarks.gauge_picture [--car CAR] --chart FILE``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from ali3.running import run_command
from benchmarks.shared.command import parser_of, pyplot, save_chart
from mbs.vehicle import Car, load

NEAR = (0.5, 0.1)  # m: the names of gauges that are nearer would lie on each other
VIEWS = ((0, 2, "z, m"), (0, 1, "y, m"))  # from the side, from above


def main(arguments: Sequence[str] | None = None) -> int:
    """Draw it from the side and from above."""
    parser = parser_of("gauge_picture", __doc__, json=False, chart="the frame")
    parser.add_argument("--car", default="prototype", help="name, folder or file; default: the prototype")
    options = parser.parse_args(arguments)
    if options.chart is None:
        parser.error("--chart FILE is needed")
    figure, axes = pyplot().subplots(2, 1, figsize=(8.6, 6.2), layout="constrained")
    for (i, j, label), a in zip(VIEWS, axes, strict=True):
        draw(a, load(options.car), i, j)
        a.set(aspect="equal", xlabel="x, m", ylabel=label)
        a.margins(y=0.12)
    axes[0].legend(loc="upper right", frameon=False)
    save_chart(figure, options.chart)
    return 0


def draw(a: Any, car: Car, i: int, j: int) -> None:
    """Tubes, joints of the suspension, and gauges by name; from the side those of both sides are one."""
    tubular = car.frame_section.tubular(car.folder)
    frame, tubes = tubular.frame()
    x = frame.positions
    for beam in frame.beams:
        ends = x[[beam.i, beam.j]]
        a.plot(ends[:, i], ends[:, j], color="0.6", lw=1.2)
    joints = np.array([car.flexible_frame.place(name) for name in car.flexible_frame.interfaces])
    a.plot(joints[:, i], joints[:, j], "o", ms=4, color="tab:blue", label="joints of the suspension")
    names: dict[tuple[float, float], list[str]] = {}
    for gauge in tubular.strain_gauges(tubes):
        beam = frame.beams[gauge.element]
        place = (1.0 - gauge.xi) * x[beam.i] + gauge.xi * x[beam.j]
        names.setdefault((round(float(place[i]), 3), round(float(place[j]), 3)), []).append(gauge.name)
    if names:
        a.plot(*np.array(list(names)).T, "s", ms=8, color="tab:red", label="strain gauges")
    places = list(names)
    for k, (place, found) in enumerate(names.items()):
        beside = any(abs(place[0] - x0) < NEAR[0] and abs(place[1] - y0) < NEAR[1] for x0, y0 in places[:k])
        style = {"xytext": (0, 9 if beside else -17), "textcoords": "offset points", "ha": "center", "color": "tab:red"}
        a.annotate(", ".join(found), place, **style)


if __name__ == "__main__":
    sys.exit(run_command(main))
