"""The frame in the kerb test, deformed and coloured by stress: ``python -m benchmarks.stress_picture [--out DIR]``.

Runs the scene kerb_test on rung 3 and draws the moment of the largest stress as PNG and the fall from the kerb as GIF:
the largest normal stress round each tube, with the deformation scaled up. Needs PyVista, an extra:
``pip install "ali3[pictures]"``; without it the picture is made by Matplotlib, without animation.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.command import parser_of, pyplot, watched
from mbs import Simulation, compile
from mbs.flexible import Frame, ReducedBody
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.scenes import kerb_test
from mbs.scenes.prototype_car.chassis import DYNAMIC, reduced_chassis
from mbs.scenes.prototype_car.frame import prototype_frame

Array = NDArray[np.float64]
SCALE = 150.0  # of the deformation
ANIMATED = (7.6, 8.9)  # s, from before the front wheels leave the kerb until after the rear wheels land
EVERY = 2  # steps of 0.01 s between two pictures
PERCENTILE = 99.5  # of the stresses, where the colours end: single joints would take all the range
CAMERA = ((2.15, -3.55, 2.25), (-1.15, 0.0, 0.42), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Motion:
    """What the pictures need.

    Attributes
    ----------
    t : ndarray, shape (n,)
        s.
    places : ndarray, shape (n, nodes, 3)
        Deformed and scaled, in the axes of the chassis, m.
    stress : ndarray, shape (n, elements, 2)
        Largest normal stress at the ends of each element, Pa.
    """

    t: Array
    places: Array
    stress: Array


def amplitudes(body: ReducedBody) -> tuple[Array, Array]:
    """Times and modal amplitudes, shape (n, modes), of the kerb test."""
    system = compile(kerb_test.build(DYNAMIC))
    names = list(system.meta["coordinates"])
    columns = [names.index(f"chassis.{mode}") for mode in body.mode_names]
    car = Simulation(system)
    t, eta = [0.0], [car.state.q[columns]]
    for _ in watched(range(round(ANIMATED[1] / kerb_test.STEP))):
        car.step(kerb_test.STEP)
        t.append(car.time)
        eta.append(car.state.q[columns])
    return np.array(t), np.array(eta)


def motion_of(frame: Frame, body: ReducedBody, t: Array, eta: Array, scale: float = SCALE) -> Motion:
    """Shapes and stresses from amplitudes."""
    moved = np.einsum("kij,nj->nki", body.node_translations, eta)
    forces = body.recovery(section_force_field(frame))
    stress = np.array([peak_tube_stress(frame, forces @ e) for e in eta])
    return Motion(t, frame.positions + scale * moved, stress)


def _mesh(pyvista: Any, frame: Frame, places: Array, stress: Array | None) -> Any:
    """Tubes of all elements; each end of an element is a point of its own, with its own stress."""
    ends = np.array([[b.i, b.j] for b in frame.beams])
    n = len(ends)
    lines = np.column_stack([np.full(n, 2), 2 * np.arange(n), 2 * np.arange(n) + 1])
    mesh = pyvista.PolyData(places[ends].reshape(-1, 3), lines=lines)
    if stress is not None:
        mesh["stress"] = stress.ravel() / 1e6
    return mesh


def draw(frame: Frame, motion: Motion, folder: Path) -> list[Path]:
    """Picture and animation with PyVista."""
    import pyvista

    limit = float(np.percentile(motion.stress, PERCENTILE) / 1e6)
    style = {
        "scalars": "stress",
        "cmap": "turbo",
        "clim": (0.0, limit),
        "scalar_bar_args": {"title": "largest normal stress, MPa", "color": "black", "n_labels": 5},
    }
    drawn = _mesh(pyvista, frame, frame.positions, None)

    def scene(size: tuple[int, int], k: int) -> Any:
        plotter = pyvista.Plotter(off_screen=True, window_size=size)
        plotter.set_background("white")
        plotter.add_mesh(drawn, color="#bbbbbb", line_width=1)
        tubes = _mesh(pyvista, frame, motion.places[k], motion.stress[k]).tube(radius=0.018)
        plotter.add_mesh(tubes, name="frame", smooth_shading=True, **style)
        plotter.camera_position = CAMERA
        plotter.add_text(f"t = {motion.t[k]:.2f} s, deformation x {SCALE:g}", font_size=11, color="black", name="time")
        return plotter

    picture, animation = folder / "frame_stress.png", folder / "frame_stress.gif"
    k = int(motion.stress.max(axis=(1, 2)).argmax())
    plotter = scene((1400, 900), k)
    plotter.screenshot(str(picture))
    plotter.close()
    shown = np.flatnonzero((motion.t > ANIMATED[0] - 1e-9) & (motion.t < ANIMATED[1] + 1e-9))[::EVERY]
    plotter = scene((700, 450), int(shown[0]))
    plotter.open_gif(str(animation), fps=12)
    for i in shown:
        tubes = _mesh(pyvista, frame, motion.places[i], motion.stress[i]).tube(radius=0.018)
        plotter.add_mesh(tubes, name="frame", smooth_shading=True, **style)
        text = f"t = {motion.t[i]:.2f} s, deformation x {SCALE:g}"
        plotter.add_text(text, font_size=9, color="black", name="time")
        plotter.write_frame()
    plotter.close()
    return [picture, animation]


def draw_plain(frame: Frame, motion: Motion, folder: Path) -> list[Path]:
    """Picture with Matplotlib."""
    plt = pyplot()
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    k = int(motion.stress.max(axis=(1, 2)).argmax())
    figure = plt.figure(figsize=(13, 8), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    ends = np.array([[b.i, b.j] for b in frame.beams])
    axes.add_collection3d(Line3DCollection(frame.positions[ends], colors="#cccccc", linewidths=0.8))
    tubes = Line3DCollection(motion.places[k][ends], cmap="turbo", linewidths=3.0)
    tubes.set_array(motion.stress[k].max(axis=1) / 1e6)
    tubes.set_clim(0.0, float(np.percentile(motion.stress, PERCENTILE) / 1e6))
    axes.add_collection3d(tubes)
    low, high = frame.positions.min(axis=0), frame.positions.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low)
    axes.set(xlabel="x, m", ylabel="y, m", zlabel="z, m")
    figure.colorbar(tubes, ax=axes, label="largest normal stress, MPa", shrink=0.6)
    axes.set_title(f"t = {motion.t[k]:.2f} s, deformation x {SCALE:g}")
    picture = folder / "frame_stress.png"
    figure.savefig(picture, dpi=100)
    plt.close(figure)
    return [picture]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run, draw, say where."""
    parser = parser_of("stress_picture", __doc__, json=False)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    parser.add_argument("--plain", action="store_true", help="draw with Matplotlib")
    options = parser.parse_args(arguments)
    frame, _ = prototype_frame()
    body = reduced_chassis(DYNAMIC)
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
    sys.exit(main())
