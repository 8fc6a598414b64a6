"""Sensors: numbers computed from the state, by the sensor types of the System file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.affine import Affine, AffineVector
from mbs.elements.record import ElementRecord
from mbs.errors import ModelError
from mbs.flexible.inertia_relief import InertiaRelief
from mbs.kernel.header import SensorType, SolverValue
from mbs.model.body import Body
from mbs.model.core import Coordinate, ModelCore
from mbs.model.flexible import FlexibleBody
from mbs.model.joints.joint import Joint
from mbs.model.ports import PortedBody
from mbs.model.reactions import Term

COMPONENTS = {"x": 0, "y": 1, "z": 2}
WORKS = ("work", "nonconservative")
ENERGIES = ("kinetic", "gravity", "elastic", "total")
SOLVER = tuple(value.name.lower() for value in SolverValue)
SOLVER_UNITS = {SolverValue.VIOLATION: "m", SolverValue.RESIDUAL: "m", SolverValue.ENERGY_ERROR: "J"}
SOLVER_WHOLE = (SolverValue.ITERATIONS, SolverValue.FACTORIZATIONS, SolverValue.HALVINGS, SolverValue.STATUS)
SIGNALS = (SensorType.SIGNAL, SensorType.SIGNAL_RATE, SensorType.SIGNAL_SECOND_RATE)
RATE_UNITS = {"m": ("m", "m/s", "m/s2"), "rad": ("rad", "rad/s", "rad/s2")}


@dataclass(frozen=True)
class Sensor:
    """One output.

    Parameters
    ----------
    type : SensorType
        Sensor type of the System file.
    signals : sequence of Affine
        Its signals; their numbers are put after `integers`.
    integers, reals : sequence
        The rest of its data.
    joint : Joint, optional
        For joint forces: the joint whose kept rows are weighted; ``integers`` are then numbers of its equations.
    joints : sequence of Joint
        Joints whose three kept rows each come last among the integers.
    terms : sequence of Term
        Products with multipliers of `joint`, which make up all integers and reals.
    whole : bool
        Whether its values are whole numbers.
    display_unit : str
        What engineers read it in, if that is not `unit`.
    notice : str
        What a run tells when the value is not zero; empty: nothing.
    """

    name: str
    unit: str
    description: str
    type: SensorType
    signals: Sequence[Affine] = ()
    integers: Sequence[int] = ()
    reals: Sequence[float] = ()
    joint: Joint | None = None
    joints: Sequence[Joint] = ()
    terms: Sequence[Term] = ()
    whole: bool = False
    display_unit: str = ""
    notice: str = ""


def component_number(component: Any, dimension: int, what: str) -> int:
    """0, 1, 2 for "x", "y", "z"."""
    k = COMPONENTS.get(component, -1) if isinstance(component, str) else -1
    if not 0 <= k < dimension:
        names = "'x' or 'y'" if dimension == 2 else "'x', 'y' or 'z'"
        raise ModelError(f"The component of {what} is {component!r}; it must be {names}.")
    return k


def spatial(v: AffineVector) -> list[Affine]:
    """Three components; a planar vector gets z = 0."""
    return [*v.components, *([Affine()] * (3 - len(v)))]


class SensorVocabulary(ModelCore):
    """The ``sense_...`` methods of a model. Each sensor has a name, a unit and a description."""

    def _sense(
        self,
        name: str,
        unit: str,
        description: str,
        type: SensorType,
        signals: Sequence[Affine] = (),
        integers: Sequence[int] = (),
        reals: Sequence[float] = (),
        joint: Joint | None = None,
        joints: Sequence[Joint] = (),
        terms: Sequence[Term] = (),
        whole: bool = False,
        display_unit: str = "",
    ) -> Sensor:
        self.unique("sensor", name)
        sensor = Sensor(
            name, unit, description, type, signals, integers, reals, joint, joints, terms, whole, display_unit
        )
        self.sensors.append(sensor)
        return sensor

    def _point(self, body: Body, point: ArrayLike | None, what: str) -> AffineVector:
        self.owned(body, what)
        if point is None:
            point = body.com
        return body.point(point)

    def _moving(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None,
        component: str,
        axes: Body | str,
        order: int,
        unit: str,
        description: str,
    ) -> Sensor:
        p = self._point(body, point, f"The sensor '{name}'")
        k = component_number(component, self.dimension, f"sensor '{name}'")
        if isinstance(axes, str):
            if axes not in ("earth", "body"):
                raise ModelError(f"The axes of sensor '{name}' are {axes!r}; they must be 'earth', 'body' or a body.")
            if axes == "earth":
                return self._sense(name, unit, description, SIGNALS[order], [p[k]], reals=[1.0])
            axes = body
        self.owned(axes, f"The sensor '{name}'")
        axis = axes.vector(np.eye(self.dimension)[k])
        return self._sense(
            name, unit, description, SensorType.COMPONENT, [*spatial(p), *spatial(axis)], integers=[order]
        )

    def sense_position(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m",
        description: str = "",
    ) -> Sensor:
        """Component of the position of a point (default: centre of mass), in earth axes or along an axis of a body,
        m.
        """
        return self._moving(name, body, point, component, axes, 0, unit, description)

    def sense_velocity(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m/s",
        description: str = "",
    ) -> Sensor:
        """Component of the velocity of a point, in earth axes or along the moving axis of a body, m/s."""
        return self._moving(name, body, point, component, axes, 1, unit, description)

    def sense_acceleration(
        self,
        name: str,
        body: Body,
        point: ArrayLike | None = None,
        component: str = "x",
        axes: Body | str = "earth",
        unit: str = "m/s2",
        description: str = "",
    ) -> Sensor:
        """Component of the acceleration of a point (without gravity), in earth axes or along the moving axis of a
        body, m/s2.
        """
        return self._moving(name, body, point, component, axes, 2, unit, description)

    def sense_component(
        self, name: str, vector: AffineVector, axis: AffineVector, order: int = 0, unit: str = "", description: str = ""
    ) -> Sensor:
        """Component of a vector between points (order 0), of its rate (1) or second rate (2) along a moving axis."""
        if order not in (0, 1, 2):
            raise ModelError(f"The order of sensor '{name}' is {order!r}; it must be 0, 1 or 2.")
        signals = [*spatial(vector), *spatial(axis)]
        return self._sense(
            name, unit or RATE_UNITS["m"][order], description, SensorType.COMPONENT, signals, integers=[order]
        )

    def sense_coordinate(
        self,
        name: str,
        coordinate: Coordinate | Affine,
        order: int = 0,
        scale: float = 1.0,
        unit: str = "",
        description: str = "",
        display_unit: str = "",
    ) -> Sensor:
        """A coordinate (relative angle, spin) or any affine expression, its rate (order 1) or second rate (order 2)."""
        if order not in (0, 1, 2):
            raise ModelError(f"The order of sensor '{name}' is {order!r}; it must be 0, 1 or 2.")
        expression = self.expression(coordinate, f"The sensor '{name}'")
        if not unit:
            unit = RATE_UNITS[coordinate.unit][order] if isinstance(coordinate, Coordinate) else "1"
        return self._sense(
            name, unit, description, SIGNALS[order], [expression], reals=[scale], display_unit=display_unit
        )

    def notice(self, sensor: Sensor, text: str) -> Sensor:
        """Let a run say `text` when a sensor is not zero: what a user should hear of without looking at every output.

        `Trajectory.notices` has the sentence with the first time and the largest value; the run goes on.
        """
        if sensor not in self.sensors or not isinstance(text, str) or not text.strip():
            raise ModelError(
                f"A notice of model {self.name!r} needs a sensor and a sentence, got {sensor!r}, {text!r}."
            )
        told = replace(sensor, notice=text)
        self.sensors[self.sensors.index(sensor)] = told
        return told

    def sense_recovery(
        self, name: str, body: FlexibleBody, weights: ArrayLike, unit: str = "", description: str = ""
    ) -> Sensor:
        """A constant row times the amplitudes of a flexible body, such as a stress of `ReducedBody.recovery`.

        Parameters
        ----------
        weights : array_like, shape (n_modes,)
            Output per unit amplitude.
        """
        if not isinstance(self.owned(body, f"The sensor '{name}'"), FlexibleBody):
            raise ModelError(f"The sensor '{name}' needs a flexible body, not '{body.name}'.")
        return self._sense(name, unit, description, SensorType.SIGNAL, [body.combination(weights)], reals=[1.0])

    def sense_angular_rate(
        self, name: str, body: Body, component: str = "z", unit: str = "rad/s", description: str = ""
    ) -> Sensor:
        """Component of the angular velocity of a body in its own axes (those along the earth axes in the reference),
        rad/s.
        """
        self.owned(body, f"The sensor '{name}'")
        k = COMPONENTS["z"] if self.dimension == 2 else component_number(component, 3, f"sensor '{name}'")
        e = np.eye(self.dimension)
        a, b = body.vector(e[(k + 1) % 3]), body.vector(e[(k + 2) % 3])
        return self._sense(name, unit, description, SensorType.ANGULAR_RATE, [*spatial(a), *spatial(b)], reals=[1.0])

    def sense_yaw(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """Angle of the body's x axis in the earth's x-y plane, rad (planar: its rotation)."""
        a = body.vector(np.eye(self.dimension)[0])
        return self._sense(name, unit, description, SensorType.ANGLE, [a[1], a[0]])

    def sense_pitch(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """-asin of the z component of the body's x axis, rad: positive nose down."""
        self._spatial_only(name)
        return self._sense(name, unit, description, SensorType.PITCH, [body.vector((1.0, 0.0, 0.0))[2]])

    def sense_roll(self, name: str, body: Body, unit: str = "rad", description: str = "") -> Sensor:
        """atan2 of the z components of the body's y and z axes, rad: positive left side up."""
        self._spatial_only(name)
        return self._sense(
            name,
            unit,
            description,
            SensorType.ANGLE,
            [body.vector((0.0, 1.0, 0.0))[2], body.vector((0.0, 0.0, 1.0))[2]],
        )

    def sense_quaternion(
        self, name: str, body: Body, component: str = "w", unit: str = "1", description: str = ""
    ) -> Sensor:
        """Component "w", "x", "y" or "z" of the orientation quaternion of a body."""
        self._spatial_only(name)
        if component not in ("w", "x", "y", "z"):
            raise ModelError(f"The component of sensor '{name}' is {component!r}; it must be 'w', 'x', 'y' or 'z'.")
        axes = [s for e in np.eye(3) for s in body.vector(e).components]
        return self._sense(name, unit, description, SensorType.QUATERNION, axes, integers=["wxyz".index(component)])

    def sense_norm(
        self, name: str, vector: AffineVector, order: int = 0, unit: str = "", description: str = ""
    ) -> Sensor:
        """Length of a vector (order 0) or of its rate (order 1): distance between points, speed of a point."""
        if order not in (0, 1):
            raise ModelError(f"The order of sensor '{name}' is {order!r}; it must be 0 or 1.")
        unit = unit or RATE_UNITS["m"][order]
        return self._sense(
            name, unit, description, SensorType.NORM, list(vector.components), integers=[order, len(vector)]
        )

    def sense_direction(
        self,
        name: str,
        point: AffineVector,
        axis_1: AffineVector,
        axis_2: AffineVector,
        order: int = 1,
        unit: str = "rad",
        description: str = "",
    ) -> Sensor:
        """Direction of the velocity of a point in moving axes, atan2(axis_2 . v, axis_1 . v), rad (side-slip angle)."""
        signals = [*spatial(point), *spatial(axis_1), *spatial(axis_2)]
        return self._sense(name, unit, description, SensorType.DIRECTION, signals, integers=[order])

    def sense_angle_between(
        self, name: str, a: AffineVector, b: AffineVector, c: AffineVector, unit: str = "rad", description: str = ""
    ) -> Sensor:
        """Angle from b to a about c, atan2((b x a) . c, a . b), rad."""
        return self._sense(name, unit, description, SensorType.ANGLE_ABOUT, [*spatial(a), *spatial(b), *spatial(c)])

    def sense_element(
        self, name: str, element: Any, output: str, scale: float = 1.0, unit: str = "", description: str = ""
    ) -> Sensor:
        """An output of a force element, such as the force of a spring."""
        element_name = getattr(element, "name", element)
        for index, record in enumerate(self.elements):
            if record.name == element_name:
                for k, out in enumerate(record.outputs):
                    if out.name == output:
                        return self._sense(
                            name,
                            unit or out.unit,
                            description or out.description,
                            SensorType.ELEMENT_OUTPUT,
                            integers=[index, k],
                            reals=[scale],
                            whole=out.whole and scale == 1.0,
                            display_unit=out.display_unit if not unit else "",
                        )
                known = ", ".join(o.name for o in record.outputs) or "none"
                raise ModelError(
                    f"The sensor '{name}' asks for '{output}' of element '{element_name}', which has: {known}."
                )
        raise ModelError(f"The sensor '{name}' asks for element '{element_name}', but the model has no such element.")

    def sense_work(
        self,
        name: str,
        elements: ElementRecord | str | Sequence[ElementRecord | str],
        kind: str = "work",
        unit: str = "J",
        description: str = "",
    ) -> Sensor:
        """Work of force elements on the mechanism since the start, J; the works of several are added.

        The sums of all elements, of kind "nonconservative", and the work of driven joints are the change of the total
        energy (`sense_energy`), but for what the steps err by (`sense_solver`, "energy_error"). Each method adds up its
        own steps: with mean forces times ways by the trapezoidal rule (second order), with the forces of discrete
        gradients by energy-momentum (exact), with powers of the stages by the others.

        Parameters
        ----------
        name : str
        elements : ElementRecord, str or sequence of them
            Force elements of this model or their names.
        kind : str
            "work": of all forces of the elements; "nonconservative": together with the change of their own potential
            energy, so that springs have none. Work that is lost, in a damper or a brake, is negative.
        unit, description : str

        Raises
        ------
        ModelError
            An element that the model does not have or that comes twice, none at all, or another kind.
        """
        if kind not in WORKS:
            raise ModelError(f"The work of sensor '{name}' is {kind!r}; it must be 'work' or 'nonconservative'.")
        given = [elements] if isinstance(elements, (ElementRecord, str)) else list(elements)
        known = {record.name: k for k, record in enumerate(self.elements)}
        names = [str(getattr(e, "name", e)) for e in given]
        for element in names:
            if element not in known:
                raise ModelError(
                    f"The sensor '{name}' asks for element '{element}', but the model has no such element; it has: "
                    f"{', '.join(known) or 'none'}."
                )
        if not names or len(set(names)) < len(names):
            raise ModelError(f"The sensor '{name}' needs at least one element and each once, got {names}.")
        numbers = [known[element] for element in names]
        return self._sense(
            name, unit, description, SensorType.WORK, integers=[WORKS.index(kind), len(numbers), *numbers]
        )

    def sense_quasi_static(
        self,
        name: str,
        body: PortedBody,
        relief: InertiaRelief,
        output: int,
        origin: ArrayLike,
        unit: str = "",
        description: str = "",
    ) -> Sensor:
        """An output of a structure that follows the forces at the ports of a rigid body and its motion at once.

        Parameters
        ----------
        relief : InertiaRelief
            Interfaces in the order of the ports, axes those of the earth in the reference configuration.
        output : int
            Row of its matrices.
        origin : array_like, shape (3,)
            Its origin in the reference configuration, m.
        """
        if not isinstance(self.owned(body, f"The sensor '{name}'"), PortedBody):
            raise ModelError(f"The sensor '{name}' needs a body with ports, not '{body.name}'.")
        n = len(body.ports)
        if relief.forces.shape[1] != 3 * n or not 0 <= output < len(relief.forces):
            raise ModelError(
                f"The sensor '{name}' needs matrices of {n} interfaces and a row of them; they have "
                f"{relief.forces.shape[1] // 3} and {len(relief.forces)} rows, the row is {output}."
            )
        signals = [*body.point(origin).components, *(s for e in np.eye(3) for s in body.vector(e).components)]
        weights = np.concatenate([relief.forces[output], relief.acceleration[output], relief.rotation[output]])
        reals = [*self.gravity, *weights]
        return self._sense(
            name, unit, description, SensorType.QUASI_STATIC, signals, [n], reals, joints=list(body.ports.values())
        )

    def sense_constant(
        self, name: str, value: float, unit: str = "1", description: str = "", whole: bool = False
    ) -> Sensor:
        """A number that does not change; `whole`: an integer for an FMU."""
        return self._sense(
            name, unit, description, SensorType.SIGNAL, [Affine({}, 1.0)], reals=[float(value)], whole=whole
        )

    def sense_energy(self, name: str, kind: str = "total", unit: str = "J", description: str = "") -> Sensor:
        """ "kinetic", "gravity", "elastic" or "total" energy, J."""
        if kind not in ENERGIES:
            raise ModelError(f"The energy of sensor '{name}' is {kind!r}; it must be one of {', '.join(ENERGIES)}.")
        return self._sense(name, unit, description, SensorType.ENERGY, integers=[ENERGIES.index(kind)])

    def sense_input(self, name: str, input: Any, unit: str = "", description: str = "") -> Sensor:
        """An input as used (clamped)."""
        if input not in self.inputs:
            raise ModelError(f"The sensor '{name}' needs an input of model '{self.name}', got {input!r}.")
        return self._sense(name, unit or input.unit, description, SensorType.INPUT, integers=[input.index])

    def sense_guide(
        self, name: str, guide: Any, order: int = 0, scale: float = 1.0, unit: str = "", description: str = ""
    ) -> Sensor:
        """A guide or its rates."""
        if guide not in self.guides or order not in (0, 1, 2):
            raise ModelError(f"The sensor '{name}' needs a guide of model '{self.name}' and an order 0, 1 or 2.")
        return self._sense(
            name, unit or guide.unit, description, SensorType.GUIDE, integers=[guide.index, order], reals=[scale]
        )

    def sense_solver(self, name: str, kind: str, description: str = "") -> Sensor:
        """What the solver says about itself.

        Parameters
        ----------
        name : str
        kind : str
            "iterations" and "status" of the last step, "violation" (m) and "residual" (m) after it; since the start
            "factorizations", "halvings", "energy_error" (J, what the steps gave where no force did) and
            "energy_balance" (the same over the largest kinetic energy and the work).
        description : str
        """
        if kind not in SOLVER:
            raise ModelError(f"The solver sensor '{name}' asks for {kind!r}; it must be one of {', '.join(SOLVER)}.")
        value = SolverValue[kind.upper()]
        return self._sense(
            name,
            SOLVER_UNITS.get(value, "1"),
            description,
            SensorType.SOLVER,
            integers=[value],
            whole=value in SOLVER_WHOLE,
        )

    def _spatial_only(self, name: str) -> None:
        if self.dimension == 2:
            raise ModelError(f"The sensor '{name}' needs a spatial model; in the plane use sense_yaw.")
