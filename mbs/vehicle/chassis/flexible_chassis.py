"""Adds a flexible chassis of checked mass to a car, with outputs of stresses and amplitudes at every fidelity."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from mbs.common.affine import AffineVector
from mbs.common.errors import ModelError
from mbs.flexible.body_plausibility import model_plausibility
from mbs.flexible.relief_matrices import InertiaRelief
from mbs.model.body import Body
from mbs.model.flexible import FlexibleBody
from mbs.model.model import Model
from mbs.model.ports import PortedBody
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.attachments import attachments
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.frame_joints import JointFinder
from mbs.vehicle.chassis.frames.frame_section import Structure
from mbs.vehicle.chassis.gauges.reading import drawn_gauges
from mbs.vehicle.chassis.mount import Mount, rigid_chassis
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.side import Point

COMPUTED_OUTPUT = "stress.computed"
MASS_TOLERANCE = 0.005  # relative to the mass
INERTIA_TOLERANCE = 0.02  # relative to the largest moment of inertia
CENTRE_TOLERANCE = 0.005  # m
_REMEDY = "Change the masses of the frame too; what a parameter of a run changes may differ: it rides on the frame."


def make_frame(car: CarContent, b: CarBuilder, parts: Callable[[CarBuilder], Iterable[object]]) -> FlexibleFrame:
    """Make the frame of a car with the joints of its parts. `b`: an empty model; `parts`: as in `attachments`.

    Raises `ModelError` if the car has no flexible frame, or its files do not describe one that fits the car.
    """
    frame, chassis = car.frame_section, car.chassis
    structure = frame.structure(car.folder)
    check_mass(structure, chassis)
    points: dict[Point, str] = {p: chassis.key(f"accelerometers.{name}") for name, p in chassis.accelerometers.items()}
    for axle in (car.front, car.rear):
        points |= {tuple(point): axle.suspension.points.key(name) for name, point in axle.suspension.points}
    b.chassis = rigid_chassis(b.m, chassis)
    driven = ("front", "rear").index(car.drive.wheels)
    joints = JointFinder(frame, structure, attachments(b, parts), points).joints(chassis, driven)
    return FlexibleFrame(frame, car.folder, structure, joints)


def flexible_chassis(m: Model, data: Chassis, flexible: FlexibleFrame, fidelity: Fidelity) -> Mount:
    """Add the chassis at a fidelity, QUASI_STATIC or a finer one."""
    origin = data.reference
    if fidelity is Fidelity.QUASI_STATIC:
        rigid = rigid_chassis(m, data).body
        ports = m.ported(rigid, {name: flexible.place(name) for name in flexible.interfaces})
        return Mount(ports, rigid, rigid, origin, _drive_axes(ports, flexible), _mean_frame(ports, flexible))
    body = m.flexible_body("chassis", flexible.reduced(fidelity))
    return Mount(body, body.frame, body, origin, _drive_axes(body, flexible), _mean_frame(body, flexible))


def _drive_axes(body: Body, flexible: FlexibleFrame) -> tuple[AffineVector, AffineVector]:
    """z and x axes by the joints of the drive, so that its torque acts on the frame as pairs of forces.

    At the origin of the floating frame, a node without rotary inertia, the torque would excite the frame.
    """
    front, rear, top = ([body.point(flexible.place(joint)) for joint in pair] for pair in flexible.joints.drive)
    p_front, p_rear, p_top = (flexible.place(pair[0]) for pair in flexible.joints.drive)
    length = float(p_front[0] - p_rear[0])
    front_weight = float(p_top[0] - p_rear[0]) / length  # of the front joints in the point below the top ones
    x = (front[0] + front[1] - rear[0] - rear[1]) * (0.5 / length)
    base = (front[0] + front[1]) * (0.5 * front_weight) + (rear[0] + rear[1]) * (0.5 * (1.0 - front_weight))
    slope = float(p_front[2] - p_rear[2])
    height = float(p_top[2] - p_front[2]) + (1.0 - front_weight) * slope
    z = ((top[0] + top[1]) * 0.5 - base) * (1.0 / height)
    return z, x - z * (slope / length) if slope else x


def _mean_frame(body: Body, flexible: FlexibleFrame) -> tuple[AffineVector, list[AffineVector], np.ndarray]:
    """Origin and axes as the smallest combinations of suspension joints that are exact for rigid motions.

    Loads on them act on the frame as forces at these joints. Loads on the floating frame itself, one node, would bend
    the floor and have no effect on a quasi-static chassis.
    """
    positions = [flexible.place(joint) for joint in flexible.carrying]
    origin = np.mean(positions, axis=0)

    def combination(sums: np.ndarray) -> AffineVector:
        terms = [body.point(p) * float(w) for p, w in zip(positions, flexible.shares(sums), strict=True)]
        return sum(terms[1:], terms[0])

    axes = [combination(np.append(e, 0.0)) for e in np.eye(3)]
    return combination(np.append(origin, 1.0)), axes, origin


def stress_outputs(m: Model, mount: Mount, flexible: FlexibleFrame) -> None:
    """Add moments and stresses at the gauges; zero on a rigid chassis, where the output `COMPUTED_OUTPUT` is 0."""
    readings, rows = flexible.structure.readings, flexible.gauge_rows
    if isinstance(mount.body, FlexibleBody):
        mount.body.gauges += drawn_gauges(readings)
    _frame_outputs(
        m,
        mount,
        [(reading.name, reading.unit, reading.description) for reading in readings],
        lambda body: [body.reduced.recovery(rows[k : k + 1])[0] for k in range(len(rows))],
        lambda: flexible.quasi_static,
    )
    text, computed = "1 where moments and stresses are computed; 0: they read zero", not mount.rigid
    m.sense_constant(COMPUTED_OUTPUT, float(computed), unit="1", description=text, whole=True, computed=computed)


def amplitude_names(flexible: FlexibleFrame) -> list[str]:
    """Names of the outputs, one per mode."""
    return [f"chassis.mode_{k + 1}" for k in range(flexible.drawn.n_modes)]


def amplitude_outputs(m: Model, mount: Mount, flexible: FlexibleFrame) -> None:
    """Add the amplitudes of the modes of fidelity 3, by which `stress_scene` draws the chassis at any fidelity.

    For a flexible chassis with other modes they are the nearest ones in the energy norm, for a quasi-static chassis
    as of the static deformation, for a rigid chassis 0.
    """
    drawn = flexible.drawn
    _frame_outputs(
        m,
        mount,
        [
            (name, "m" if k < drawn.n_static else "1", f"amplitude of mode '{mode}' of the chassis, for pictures")
            for k, (name, mode) in enumerate(zip(amplitude_names(flexible), drawn.mode_names, strict=True))
        ],
        lambda body: flexible.drawn_amplitudes(body.reduced),
        lambda: flexible.quasi_static_amplitudes,
    )


def _frame_outputs(
    m: Model,
    mount: Mount,
    outputs: Sequence[tuple[str, str, str]],
    rows: Callable[[FlexibleBody], Sequence[np.ndarray] | np.ndarray],
    relief: Callable[[], InertiaRelief],
) -> None:
    """Add outputs that are linear in the deformation of the frame; zero on a rigid chassis.

    `outputs`: name, unit and description of each; `rows`: their rows by the amplitudes of a flexible chassis; `relief`:
    their matrices from the loads on a quasi-static one.
    """
    body = mount.body
    amplitude_rows = rows(body) if isinstance(body, FlexibleBody) else ()
    for k, (name, unit, text) in enumerate(outputs):
        text = f"{text}; zero where {COMPUTED_OUTPUT} is 0"
        if isinstance(body, FlexibleBody):
            m.sense_coordinate(name, body.combination(amplitude_rows[k]), unit=unit, description=text)
        elif isinstance(body, PortedBody):
            m.sense_quasi_static(name, body, relief(), k, mount.origin, unit=unit, description=text)
        else:
            m.sense_constant(name, 0.0, unit=unit, description=text, computed=False)


def check_mass(structure: Structure, chassis: Chassis) -> None:
    """Compare the mass properties of a frame, with all masses on it, with the rigid chassis.

    Raises `ModelError` if mass, centre of mass or inertia differ.
    """
    points, riding = structure.model.mass, structure.riding
    masses = np.concatenate([points.masses, list(riding.values())])
    positions = np.vstack([points.positions, *(structure.joints[joint] for joint in riding)])
    total = float(masses.sum())
    if abs(total - chassis.mass) > MASS_TOLERANCE * chassis.mass:
        (plausibility,) = model_plausibility(structure.model, modes=False, beside=chassis.mass - sum(riding.values()))
        causes = "".join(f"{sentence} " for sentence in plausibility.warnings() if "would explain it" in sentence)
        raise ModelError(
            f"{chassis.key('mass')} is {chassis.mass:g} kg, but the frame with the masses it carries has "
            f"{total:.6g} kg. {causes}{_REMEDY}"
        )
    centre = masses @ positions / total
    if np.linalg.norm(centre - chassis.com) > CENTRE_TOLERANCE:
        raise ModelError(
            f"{chassis.key('com')} is {list(chassis.com)} m, but the centre of mass of the frame with the masses it "
            f"carries is {_round(centre, 4)} m. {_REMEDY}"
        )
    arms = positions - centre
    second_moments = (masses[:, None] * arms).T @ arms
    tensor = np.trace(second_moments) * np.eye(3) - second_moments
    chassis_tensor = np.array(chassis.tensor)
    if np.abs(tensor - chassis_tensor).max() > INERTIA_TOLERANCE * chassis_tensor.max():
        (x, xy, xz), (_, y, yz), (_, _, z) = tensor
        raise ModelError(
            f"{chassis.key('inertia')} is {list(chassis.inertia)} kg.m2 and products {list(chassis.products)}, but the "
            f"frame with the masses it carries has {_round((x, y, z), 2)} and {_round((xy, xz, yz), 2)} kg.m2. "
            f"{_REMEDY}"
        )


def _round(values: object, digits: int) -> list[float]:
    """Values rounded for a message."""
    return [round(float(v), digits) + 0.0 for v in np.asarray(values)]
