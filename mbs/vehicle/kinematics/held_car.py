"""Model of a car with a fixed chassis, steering and suspensions, without tyres, brakes and gravity."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.common.errors import ModelError
from mbs.elements.road import PlaneRoad
from mbs.model.body import Body
from mbs.model.model import Model
from mbs.simulation.evaluator import RANK_TOLERANCE, SHIFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car import Car
from mbs.vehicle.chassis.flexible_chassis import flexible_chassis
from mbs.vehicle.chassis.mount import rigid_chassis
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.linkages.standing_model import Linear, StandingModel, rotation_rate
from mbs.vehicle.side import Point, sides

Array = NDArray[np.float64]

POSITION_TOLERANCE = 1e-9  # m, of the equilibrium
MAX_ITERATIONS = 30


@dataclass(frozen=True)
class HeldWheel:
    """Small motions of a wheel as rows by coordinates."""

    radius: float
    """Distance from the wheel centre to the contact centre, m."""
    centre: Array
    axis: Array
    turn: Array
    contact: Array
    """`centre`, `axis`, `turn`, `contact`, shape (3, nq): of the wheel centre, the wheel axis to the left, the rotation
    of the carrier, and the carrier's point at the contact centre."""


def held_model(car: Car, fidelity: Fidelity) -> tuple[Model, CarBuilder, dict[str, tuple[Body, Point]]]:
    """Build the model with a free chassis; return it with carrier and centre as drawn of each wheel on links.

    `car`: a car without faults.
    """
    m = Model(f"{car.name} held", gravity=(0.0, 0.0, 0.0))
    m.start_in_equilibrium = False
    m.floating = True
    steering = m.input("steering", min=-1.0, max=1.0)
    b = CarBuilder(m, m.road(PlaneRoad()), {"steering": steering})
    if fidelity.rigid:
        b.chassis = rigid_chassis(m, car.chassis)
    else:
        b.chassis = flexible_chassis(m, car.chassis, car.flexible_frame, fidelity)
    carriers: dict[str, tuple[Body, Point]] = {}
    for axle, data in car.linked_axles.items():
        tie_rod_end = car.steering.build(b, car.rack_direction).tie_rod if axle == "front" else b.chassis.fixed_end
        corners = data.corners(b, axle, tie_rod_end)
        carriers |= {c.side.wheel: (c.carrier, c.side.point(data.wheel.centre)) for c in corners}
    return m, b, carriers


class HeldCar(StandingModel):
    """A car in equilibrium with the contact centres at the heights of the drawing.

    `car`: a car without faults.

    Attributes
    ----------
    q : ndarray, shape (nq,)
        Coordinates.
    wheels : dict of str to HeldWheel
        Wheels of axles with links by name: FL, FR, RL, RR.
    """

    def __init__(self, car: Car, fidelity: Fidelity) -> None:
        m, b, carriers = held_model(car, fidelity)
        super().__init__(m)
        alignment_axes = {
            side.wheel: tuple(data.alignment.axes(side))
            for axle, data in car.linked_axles.items()
            for side in sides(axle)
        }
        self._wheel_points = {
            name: (
                _vector_to_ground(centre, alignment_axes[name][2]),
                [self.linear(v) for v in (carrier.point(centre), *map(carrier.vector, alignment_axes[name]))],
            )
            for name, (carrier, centre) in carriers.items()
        }
        origin, axes, _ = b.chassis.contact_frame
        middle, (x, y, _) = self.linear(origin)[0], (self.linear(axis)[0] for axis in axes)
        self._chassis_rows = np.vstack([middle, x[1:], y[2:]])  # translations and rotations of the mean frame
        self.q = np.array(self.evaluator.state.q)
        self._find_equilibrium()

    @property
    def wheels(self) -> dict[str, HeldWheel]:
        """Small motions of the wheels, by name."""
        return {name: self._wheel(*parts) for name, parts in self._wheel_points.items()}

    def rows(self, q: Array) -> Array:
        """Jacobian (n, nq) of the constraints of joints and chassis. `q`: coordinates, shape (nq,)."""
        return np.vstack([self.evaluator.jacobian(q), self._chassis_rows])

    def wheel_rows(self) -> Array:
        """Rows of the heights of the contact centres, shape (number of wheels, nq)."""
        return np.array([wheel.contact[2] for wheel in self.wheels.values()])

    def flexibility(self, held: Array) -> tuple[Array, Array]:
        """Small motions that all constraints allow, and the inverse of their stiffness.

        `held`: rows of further constraints, shape (k, nq).

        Returns
        -------
        V : ndarray, shape (nq, n)
            Motions.
        flexibility : ndarray, shape (n, n)
            Their flexibility.
        """
        jacobian = self.rows(self.q)
        all_rows = np.vstack([jacobian, self.wheel_rows()])
        lam = np.linalg.lstsq(all_rows.T, self.force(self.q), rcond=RANK_TOLERANCE)[0]
        V = scipy.linalg.null_space(np.vstack([jacobian, held]), rcond=RANK_TOLERANCE)
        if not V.shape[1]:
            return V, np.zeros((0, 0))
        stiffness = np.zeros((V.shape[1], V.shape[1]))
        for j, v in enumerate(V.T):
            forward, backward = self.q + SHIFT * v, self.q - SHIFT * v
            force_derivative = (self.force(forward) - self.force(backward)) / (2.0 * SHIFT)
            constraint_derivative = (self.rows(forward) - self.rows(backward)).T @ lam[: len(jacobian)] / (2.0 * SHIFT)
            stiffness[:, j] = V.T @ (constraint_derivative - force_derivative)
        for load, wheel in zip(lam[len(jacobian) :], self.wheels.values(), strict=True):
            axis_z = wheel.axis[2] @ V  # the contact centre of an inclined wheel rises by R (1 - cos)
            stiffness += load * wheel.radius * np.outer(axis_z, axis_z)
        return V, np.asarray(np.linalg.inv(0.5 * (stiffness + stiffness.T)))

    def _find_equilibrium(self) -> None:
        """Find the equilibrium of frame and springs by Newton's method on the motions that the constraints allow."""
        zero_rates = np.zeros(len(self.q))
        fixed_rows = np.vstack(
            [self._chassis_rows, np.array([parts[0][0][2] for _, parts in self._wheel_points.values()])]
        )
        fixed_values = fixed_rows @ self.q
        for _ in range(MAX_ITERATIONS):
            V, flexibility = self.flexibility(self.wheel_rows())
            correction = V @ (flexibility @ (V.T @ self.force(self.q)))
            self.q = self.q + correction
            for _ in range(5):
                phi, jacobian, _ = self.evaluator.constraints(self.q, zero_rates)
                residuals = np.concatenate([phi, fixed_rows @ self.q - fixed_values])
                self.q = self.q - np.linalg.lstsq(np.vstack([jacobian, fixed_rows]), residuals, rcond=RANK_TOLERANCE)[0]
            if not np.abs(correction).max(initial=0.0) > POSITION_TOLERANCE:
                return
        raise ModelError("The frame of the held car finds no equilibrium with its springs.")

    def _wheel(self, down: Array, parts: list[Linear]) -> HeldWheel:
        """Small motions of a wheel. `down`: vector from its centre to the contact, m; `parts`: linear centre and
        axes."""
        centre, *axes = parts
        rotation = rotation_rate(axes, self.q, np.eye(len(self.q)))
        contact = centre[0] + np.cross(rotation, down, axisa=0).T
        return HeldWheel(float(np.linalg.norm(down)), centre[0], axes[1][0], rotation, contact)


def _vector_to_ground(centre: Point, up: Point) -> Array:
    """Vector from the wheel centre to the ground in the wheel plane as drawn, m, shape (3,)."""
    return np.multiply(-centre[2] / up[2], up)
