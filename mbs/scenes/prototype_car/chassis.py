"""The chassis of every fidelity, with the same outputs: rigid, with quasi-static stresses, or flexible."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from mbs.affine import AffineVector
from mbs.flexible import (
    FiniteElementModel,
    InertiaRelief,
    ReducedBody,
    craig_bampton,
    gauge_rows,
    inertia_relief,
    load_path_modes,
)
from mbs.flexible.load_path_modes import load_path_deformations
from mbs.flexible.recovery import StrainGauge
from mbs.model import Model
from mbs.model.body import Body
from mbs.model.flexible import FlexibleBody
from mbs.model.ports import PortedBody
from mbs.scenes.prototype_car import car_data
from mbs.scenes.prototype_car.fidelity import Fidelity
from mbs.scenes.prototype_car.frame import (
    DAMPING,
    DYNAMIC_MODES,
    GAUGES,
    INTERFACES,
    REFERENCE,
    joint_places,
    prototype_frame,
    strain_gauges,
)

MANY_MODES = 40
LOAD_FILE = Path(__file__).parent / "frame" / "loads.csv"
LOAD_PATH_TOLERANCE = 5e-3
"""Load paths whose deformation has less than this part of the largest, in the energy norm, are left out."""
# wishbones hold the distance of their two pivots: no load stretches the frame between them
STIFF_PAIRS = tuple((f"{a}{s}", f"{b}{s}") for a, b in (("LF", "LR"), ("UF", "UR"), ("AF", "AR")) for s in "LR")


GROUND_PATH = ("LF", "AF", "AR", "TR")
"""Suspension joints, left and right, through which the ground's forces on the chassis go into a flexible frame: those
that the final drive ties together anyway and one more, since each makes the tangent wider."""


@dataclass(frozen=True)
class Chassis:
    """What the rest of the car needs of the chassis.

    Attributes
    ----------
    body : Body
        What joints and springs take.
    frame : Body
        Rigid body, or floating frame: axes and points that do not deform.
    origin : tuple of float
        The reference node in the drawing, m.
    accelerated : Body
        Where accelerometers sit.
    drive_axes : tuple of AffineVector
        z and x axes that take the reaction of the final drive.
    contact_frame : tuple of AffineVector, list of AffineVector, ndarray
        Origin, axes and place of the origin in the drawing, m, that take the forces of the ground on the chassis.
    """

    body: Body
    frame: Body
    accelerated: Body
    origin: tuple[float, float, float]
    drive_axes: tuple[AffineVector, AffineVector]
    contact_frame: tuple[AffineVector, list[AffineVector], np.ndarray]


@cache
def _finite_elements() -> tuple[FiniteElementModel, tuple[StrainGauge, ...], np.ndarray]:
    """Model, gauges, and rows of the four moments, then of the four half-bridges."""
    frame, tubes = prototype_frame()
    gauges = strain_gauges(tubes)
    return frame.finite_element_model(), gauges, np.vstack(gauge_rows(frame, gauges))


def reduced_chassis(fidelity: Fidelity | int | str) -> ReducedBody:
    """The frame with the modes of a flexible fidelity."""
    return _reduced_chassis(Fidelity.of(fidelity))


@cache
def _reduced_chassis(fidelity: Fidelity) -> ReducedBody:
    model, _, _ = _finite_elements()
    if fidelity is Fidelity.PAPER:
        return craig_bampton(model, REFERENCE, INTERFACES, DYNAMIC_MODES, damping=DAMPING)
    count = {Fidelity.LOAD_PATHS: 0, Fidelity.DYNAMIC: DYNAMIC_MODES, Fidelity.MANY_MODES: MANY_MODES}[fidelity]
    body = craig_bampton(model, REFERENCE, INTERFACES, count, inertia_modes=True, damping=DAMPING)
    if fidelity is not Fidelity.LOAD_PATHS:
        return body
    # without the stretch between the pivots of a wishbone the frame could not follow its fixed length, and without
    # all directions at the origin a guide, which pushes a pitched car upwards too, would bend it wrongly
    loads, pairs = recorded_loads(), _relief_with_stretch()[1]
    every = np.hstack([loads, pairs, np.zeros((len(loads), 3))])
    guided = np.zeros((6, every.shape[1]))
    guided[:3, -3:] = np.eye(3)
    deformation = load_path_deformations(body, every, guided)
    size = np.sqrt(np.einsum("ik,ij,jk->k", deformation, body.K, deformation))
    scale = np.ones(every.shape[1])
    scale[loads.shape[1] :] = size[: loads.shape[1]].max() / size[loads.shape[1] :]
    return load_path_modes(body, every * scale, LOAD_PATH_TOLERANCE, guided * scale)


def recorded_loads() -> np.ndarray:
    """Principal combinations of the interface forces in driving, shape (60, n), N; see the head of the file."""
    with LOAD_FILE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return np.array([[float(v) for v in row[2:]] for row in rows[1:]])


def settled_loads(forces: np.ndarray) -> np.ndarray:
    """Interface forces, shape (60, n), N, with the wishbones' axial forces that keep their pivots apart."""
    relief, pairs, n = _relief_with_stretch()
    return np.asarray(forces - pairs @ np.linalg.solve(relief.forces[n:] @ pairs, relief.balanced[n:] @ forces))


def deformation_energy(forces: np.ndarray) -> np.ndarray:
    """Products of the deformations under interface forces, freely accelerated, in the energy norm, shape (n, n), J."""
    body = craig_bampton(_finite_elements()[0], REFERENCE, INTERFACES, 0, inertia_modes=True)
    deformation = load_path_deformations(body, forces)
    return np.asarray(deformation.T @ body.K @ deformation)


@cache
def _relief_with_stretch() -> tuple[InertiaRelief, np.ndarray, int]:
    """From loads to the gauges and to the stretch between pivots; forces per axial force; number of gauge rows."""
    model, _, outputs = _finite_elements()
    stretch = np.zeros((len(STIFF_PAIRS), model.n_dof))
    pairs = np.zeros((3 * len(INTERFACES), len(STIFF_PAIRS)))
    for k, pair in enumerate(STIFF_PAIRS):
        a, b = (model.node(name) for name in pair)
        along = model.positions[a] - model.positions[b]
        along /= np.linalg.norm(along)
        for node, name, sign in ((a, pair[0], 1.0), (b, pair[1], -1.0)):
            stretch[k, model.freedoms(node)[:3]] = sign * along
            start = 3 * INTERFACES.index(name)
            pairs[start : start + 3, k] = sign * along
    relief = inertia_relief(model, REFERENCE, INTERFACES, np.vstack([outputs, stretch]))
    return relief, pairs, len(outputs)


@cache
def quasi_static() -> InertiaRelief:
    """From interface forces and motion to the moments and half-bridges; wishbones keep their pivots apart."""
    relief, pairs, n = _relief_with_stretch()
    # forces of each wishbone along its axis that undo the stretch
    undo = -relief.forces[:n] @ pairs @ np.linalg.inv(relief.forces[n:] @ pairs)

    def mixed(part: np.ndarray) -> np.ndarray:
        return np.asarray(part[:n] + undo @ part[n:])

    return InertiaRelief(
        mixed(relief.forces),
        mixed(relief.acceleration),
        mixed(relief.rotation),
        mixed(relief.balanced),
        relief.acceleration_of_forces,
    )


def chassis(m: Model, fidelity: Fidelity) -> Chassis:
    """Add the chassis."""
    if fidelity in (Fidelity.RIGID, Fidelity.QUASI_STATIC):
        rigid = m.body("chassis", **car_data.CHASSIS)
        if fidelity is Fidelity.RIGID:
            axes = rigid.vector((0.0, 0.0, 1.0)), rigid.vector((1.0, 0.0, 0.0))
            frame = rigid.point(rigid.com), [rigid.vector(v) for v in np.eye(3)], rigid.com
            return Chassis(rigid, rigid, rigid, car_data.FLOOR_CENTRE, axes, frame)
        model, _, _ = _finite_elements()
        ports = m.ported(rigid, {name: model.positions[model.node(name)] for name in INTERFACES})
        return Chassis(ports, rigid, rigid, car_data.FLOOR_CENTRE, _rear_axes(ports), _mean_frame(ports))
    flexible = m.flexible_body("chassis", reduced_chassis(fidelity))
    return Chassis(
        flexible, flexible.frame, flexible, car_data.FLOOR_CENTRE, _rear_axes(flexible), _mean_frame(flexible)
    )


def _rear_axes(body: Body) -> tuple[AffineVector, AffineVector]:
    """z and x axes through the rear suspension's joints, where the final drive hangs: its torque loads them in pairs.

    At the origin of the floating frame, a node without rotary inertia of its own, it would shake the frame.
    """
    front, rear, top = (
        [body.point(np.array(car_data.REAR[name]) * (1.0, sign, 1.0)) for sign in (1.0, -1.0)]
        for name in ("lower_pivot_front", "lower_pivot_rear", "strut_top")
    )
    x_front, x_rear, x_top = (car_data.REAR[name][0] for name in ("lower_pivot_front", "lower_pivot_rear", "strut_top"))
    share = (x_top - x_rear) / (x_front - x_rear)  # of the front pivots in the place under the strut tops
    x = (front[0] + front[1] - rear[0] - rear[1]) * (0.5 / (x_front - x_rear))
    below = (front[0] + front[1]) * (0.5 * share) + (rear[0] + rear[1]) * (0.5 * (1.0 - share))
    height = car_data.REAR["strut_top"][2] - car_data.REAR["lower_pivot_front"][2]
    return ((top[0] + top[1]) * 0.5 - below) * (1.0 / height), x


def _mean_frame(body: Body) -> tuple[AffineVector, list[AffineVector], np.ndarray]:
    """Origin and axes as the shortest combinations of suspension joints that are right for every rigid motion.

    What acts on them loads the frame as forces at these joints. At the floating frame itself, one node, it would bend
    the floor; a quasi-static chassis would miss it.
    """
    places = joint_places()
    named = [places[f"{joint}{side}"] for joint in GROUND_PATH for side in "LR"]
    origin = np.mean(named, axis=0)
    rigid = np.vstack([np.array(named).T, np.ones(len(named))])

    def combination(sums: np.ndarray) -> AffineVector:
        weights = np.linalg.lstsq(rigid, sums, rcond=None)[0]
        terms = [body.point(p) * float(w) for p, w in zip(named, weights, strict=True)]
        return sum(terms[1:], terms[0])

    axes = [combination(np.append(e, 0.0)) for e in np.eye(3)]
    return combination(np.append(origin, 1.0)), axes, origin


def stress_outputs(m: Model, chassis: Chassis, fidelity: Fidelity) -> None:
    """Moments and stresses at the gauges; zero for the rigid chassis, where `stress.computed` says so."""
    _, _, rows = _finite_elements() if fidelity is not Fidelity.RIGID else (None, None, None)
    note = "; zero where stress.computed is 0"
    names = list(GAUGES)
    outputs = [
        (f"bending_moment.{g}", "N.m", f"bending moment at gauge {g}, positive: upper fibre pulled") for g in names
    ]
    outputs += [(f"stress.{g}", "Pa", f"half-bridge {g}, upper minus lower fibre") for g in names]
    for k, (name, unit, text) in enumerate(outputs):
        if fidelity is Fidelity.RIGID:
            m.sense_constant(name, 0.0, unit, text + note)
        elif isinstance(chassis.body, PortedBody):
            m.sense_quasi_static(name, chassis.body, quasi_static(), k, chassis.origin, unit, text + note)
        else:
            body = chassis.body
            assert isinstance(body, FlexibleBody)
            assert rows is not None
            m.sense_recovery(name, body, body.reduced.recovery(rows[k : k + 1])[0], unit, text + note)
    text = "1 where moments and stresses are computed; 0: they read zero"
    m.sense_constant("stress.computed", float(fidelity is not Fidelity.RIGID), "1", text, whole=True)


__all__ = ["Chassis", "chassis", "quasi_static", "reduced_chassis", "stress_outputs"]
