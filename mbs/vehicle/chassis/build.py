"""Adds the chassis of any fidelity to a car, and its stresses."""

from __future__ import annotations

import numpy as np

from mbs.common.affine import AffineVector
from mbs.model import Model
from mbs.model.body import Body
from mbs.model.flexible import FlexibleBody
from mbs.model.ports import PortedBody
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.mount import Mount
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.fidelity import Fidelity


def build_chassis(m: Model, data: Chassis, flexible: FlexibleFrame | None, fidelity: Fidelity) -> Mount:
    """Add the chassis.

    `flexible`: needed from QUASI_STATIC on; `fidelity`: how much of it is modelled.
    """
    origin = data.reference
    if fidelity.rigid or flexible is None:
        rigid = _rigid(m, data)
        axes = rigid.vector((0.0, 0.0, 1.0)), rigid.vector((1.0, 0.0, 0.0))
        frame = rigid.point(rigid.com), [rigid.vector(v) for v in np.eye(3)], rigid.com
        return Mount(rigid, rigid, rigid, origin, axes, frame)
    if fidelity is Fidelity.QUASI_STATIC:
        rigid = _rigid(m, data)
        ports = m.ported(rigid, {name: flexible.place(name) for name in flexible.interfaces})
        return Mount(ports, rigid, rigid, origin, _drive_axes(ports, flexible), _mean_frame(ports, flexible))
    body = m.flexible_body("chassis", flexible.reduced(fidelity))
    return Mount(body, body.frame, body, origin, _drive_axes(body, flexible), _mean_frame(body, flexible))


def _rigid(m: Model, data: Chassis) -> Body:
    return m.body("chassis", mass=data.mass, com=data.com, inertia=data.tensor)


def _drive_axes(body: Body, flexible: FlexibleFrame) -> tuple[AffineVector, AffineVector]:
    """z and x axes through the joints where the drive hangs: its torque loads them in pairs.

    At the origin of the floating frame, a node without rotary inertia of its own, it would shake the frame.
    """
    front, rear, top = ([body.point(flexible.place(joint)) for joint in pair] for pair in flexible.joints.drive)
    p_front, p_rear, p_top = (flexible.place(pair[0]) for pair in flexible.joints.drive)
    length = float(p_front[0] - p_rear[0])
    share = float(p_top[0] - p_rear[0]) / length  # of the front joints in the place under the top ones
    x = (front[0] + front[1] - rear[0] - rear[1]) * (0.5 / length)
    below = (front[0] + front[1]) * (0.5 * share) + (rear[0] + rear[1]) * (0.5 * (1.0 - share))
    slope = float(p_front[2] - p_rear[2])
    height = float(p_top[2] - p_front[2]) + (1.0 - share) * slope
    z = ((top[0] + top[1]) * 0.5 - below) * (1.0 / height)
    return z, x - z * (slope / length) if slope else x


def _mean_frame(body: Body, flexible: FlexibleFrame) -> tuple[AffineVector, list[AffineVector], np.ndarray]:
    """Origin and axes as the shortest combinations of suspension joints that are right for every rigid motion.

    What acts on them loads the frame as forces at these joints. At the floating frame itself, one node, it would bend
    the floor; a quasi-static chassis would miss it.
    """
    named = [flexible.place(joint) for pair in flexible.joints.ground for joint in pair]
    origin = np.mean(named, axis=0)
    rigid = np.vstack([np.array(named).T, np.ones(len(named))])

    def combination(sums: np.ndarray) -> AffineVector:
        weights = np.linalg.lstsq(rigid, sums, rcond=None)[0]
        terms = [body.point(p) * float(w) for p, w in zip(named, weights, strict=True)]
        return sum(terms[1:], terms[0])

    axes = [combination(np.append(e, 0.0)) for e in np.eye(3)]
    return combination(np.append(origin, 1.0)), axes, origin


def stress_outputs(m: Model, mount: Mount, flexible: FlexibleFrame, fidelity: Fidelity) -> None:
    """Moments and stresses at the gauges; zero for the rigid chassis, where `stress.computed` says so."""
    note = "; zero where stress.computed is 0"
    for k, reading in enumerate(flexible.structure.readings):
        name, unit, text = reading.name, reading.unit, reading.description
        if fidelity.rigid:
            m.sense_constant(name, 0.0, unit=unit, description=text + note, computed=False)
        elif isinstance(mount.body, PortedBody):
            m.sense_quasi_static(
                name, mount.body, flexible.quasi_static, k, mount.origin, unit=unit, description=text + note
            )
        else:
            body = mount.body
            assert isinstance(body, FlexibleBody)
            row = body.reduced.recovery(flexible.gauge_rows[k : k + 1])[0]
            m.sense_coordinate(name, body.combination(row), unit=unit, description=text + note)
    text = "1 where moments and stresses are computed; 0: they read zero"
    computed = not fidelity.rigid
    m.sense_constant("stress.computed", float(computed), unit="1", description=text, whole=True, computed=computed)
