"""The frame in the kerb test, deformed and coloured by stress: motion and pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.files import whole_file
from benchmarks.shared.command import pyplot, watched
from mbs import Simulation, compile
from mbs.flexible import Frame, ReducedBody
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity

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
    system = compile(kerb_test.build(Fidelity.DYNAMIC))
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
    with whole_file(picture) as made:
        figure.savefig(made, dpi=100)
    plt.close(figure)
    return [picture]
