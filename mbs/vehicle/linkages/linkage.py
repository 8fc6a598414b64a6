"""Suspension of an axle on a fixed chassis as a mechanism with prescribed travel of wheels and rack.

The model has the joints, springs and bars of the car's templates, but no tyres, brakes or gravity. With the constraint
equations Phi(q, s) of the joints, the travel s of the rack and the heights c_z of both wheel centres, a position solves

    Phi(q, s) = 0,    c_z(q) = c_z(drawn) + travel,

by the Gauss-Newton method: each correction is the shortest solution of the linearised equations, so that redundant
rows are allowed. The tangent of the position follows from the same matrix, and its derivative along a direction from
d(Phi_q)/dt qd, without finite differences.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from mbs.common.affine import AffineVector
from mbs.elements.road import PlaneRoad
from mbs.model.joint_ends import End
from mbs.model.model import Model
from mbs.simulation.evaluator import RANK_TOLERANCE
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.mount import Mount
from mbs.vehicle.linkages.standing_model import Linear, StandingModel
from mbs.vehicle.side import Point, Side
from mbs.vehicle.steering.rack_section import rack_ends
from mbs.vehicle.suspensions.anti_roll_bar import LINK

Array = NDArray[np.float64]

SIDES = ("left", "right")
MAX_RACK_TRAVEL = 1.0  # m
CORRECTION_TOLERANCE = 1e-11  # m: largest correction of a converged position
MAX_ITERATIONS = 12
RESIDUAL_TOLERANCE = 1e-9  # largest residual of a converged position, in the units of the equations


class NotReachedError(ValueError):
    """A position that the linkage cannot reach."""


@dataclass(frozen=True)
class Position:
    """A position of the linkage with its tangent."""

    travel: Array
    """Travel of the left and the right wheel centre along z from the drawing, m, positive in bump, shape (2,)."""
    rack: float
    """Travel of the rack from the drawing, m, positive to the left."""
    q: Array
    """Coordinates, shape (nq,)."""
    tangent: Array
    """Derivatives of the coordinates with respect to the travel of the left wheel, the right wheel and the rack, shape
    (nq, 3)."""


class Linkage(StandingModel):
    """Suspension of one axle as a mechanism.

    Parameters
    ----------
    car : Car
        Without faults.

    Attributes
    ----------
    model : Model
        Its model, with the ground as the chassis.
    drawn : Position
        Position as drawn.
    has_rod : bool
        Whether the wheels have tie rods or toe links.
    springs, dampers : tuple of AffineVector
        Vectors between the ends, left and right.
    levers : tuple of int
        Indices of the angles of the anti-roll bar's levers among the full coordinates; empty without a bar.
    """

    def __init__(self, car: CarContent, axle: str) -> None:
        self.car, self.name, self.data = car, axle, getattr(car, axle)
        self.data.suspension.require_links()
        m = self.model = Model(f"{car.name} {axle} suspension", gravity=(0.0, 0.0, 0.0))
        b = CarBuilder(m, m.road(PlaneRoad()), {})
        b.chassis = _fixed_chassis(m, car)
        # the time is the travel of the rack
        ramp = PPoly(np.array([[1.0], [-MAX_RACK_TRAVEL]]), np.array([-MAX_RACK_TRAVEL, MAX_RACK_TRAVEL]))
        rack = m.guide_time("rack", ramp, unit="m")
        steered = car.steering.ends(b, rack, car.rack_direction) if axle == "front" else rack_ends(b, rack)
        rods: list[str] = []

        def end(side: Side, point: Point) -> End:
            rods.append(side.wheel)
            return steered(side, point)

        self._corners = corners = list(self.data.corners(b, axle, end))
        m.start_in_equilibrium = False
        self.has_rod = bool(rods)
        elements = {e.name: e for e in m.elements}
        lines = [
            [AffineVector(tuple(elements[name].signals[:3])) for name in names]
            for names in zip(*(_line_names(elements, c.side.wheel) for c in corners), strict=True)
        ]
        self.springs, self.dampers = (tuple(pair) for pair in lines)
        self.levers = tuple(k for k, c in enumerate(m.coordinates) if c.name.startswith(LINK))
        super().__init__(m)
        self._centres = [self.linear(c.carrier.point(c.side.point(self.data.wheel.centre))) for c in corners]
        self._triads = [[self.linear(c.carrier.vector(e)) for e in self.data.alignment.axes(c.side)] for c in corners]
        self._heights = np.array([centre[0][2] for centre in self._centres])
        start = np.array(self.evaluator.arrays["q0"])
        self._drawn_heights = self._heights @ start + [centre[1][2] for centre in self._centres]
        self.drawn = self.solve(start, np.zeros(2), 0.0)

    def centre(self, side: int) -> Linear:
        """A wheel centre. `side`: 0 left, 1 right."""
        return self._centres[side]

    def triad(self, side: int) -> list[Linear]:
        """Unit vectors of a wheel carrier: forward, along the wheel axis, up in its plane."""
        return self._triads[side]

    def loaded_radius(self, side: int) -> float:
        """Distance from the wheel centre to the ground in the wheel plane as drawn, m."""
        *_, up = self.data.alignment.axes(self._corners[side].side)
        return float(self.data.wheel.centre[2] / up[2])

    def length(self, line: AffineVector, q: Array) -> tuple[float, Array]:
        """Length of a spring or damper, m, and its derivatives with respect to the coordinates, shape (nq,).

        `q`: coordinates, shape (nq,).
        """
        D, d = self.linear(line)
        line_vector = D @ q + d
        length = float(np.linalg.norm(line_vector))
        return length, line_vector @ D / length

    def solve(self, start: Array, travel: Array, rack: float) -> Position:
        """Find a position by Newton's method.

        `start`: initial coordinates, shape (nq,); `travel`: travel of the left and the right wheel, m, shape (2,);
        `rack`: travel of the rack, m. Raises `NotReachedError` if the iteration does not converge.
        """
        offset, heights = [centre[1][2] for centre in self._centres], self._drawn_heights + travel

        def equations(q: Array) -> tuple[Array, Array]:
            return self._heights @ q + offset - heights, self._heights

        what = f"travels of {travel[0]:g} and {travel[1]:g} m"
        q, rows, rack_derivative = self.converged(start, rack, equations, what)
        right_sides = np.zeros((len(rows), 3))
        right_sides[-2, 0] = right_sides[-1, 1] = 1.0
        right_sides[:-2, 2] = -rack_derivative
        tangent = np.linalg.lstsq(rows, right_sides, rcond=RANK_TOLERANCE)[0]
        if np.abs(rows @ tangent - right_sides).max() > 1e-6:  # at a dead point there is no tangent
            raise NotReachedError(_not_reached(what, rack))
        return Position(travel, rack, q, np.asarray(tangent, float))

    def at_springs(self, start: Array, compression: tuple[float, float], rack: float) -> Array:
        """Coordinates (nq,) at compressions of both springs and a travel of the rack, by Newton's method from `start`.

        `compression`: compression of the left and the right spring from the drawing, m; `rack`: m. Raises
        `NotReachedError` if the iteration does not converge.
        """
        drawn_lengths = [self.length(spring, self.drawn.q)[0] for spring in self.springs]

        def equations(q: Array) -> tuple[Array, Array]:
            values, rows = zip(*(self.length(spring, q) for spring in self.springs), strict=True)
            return np.array(values) - drawn_lengths + compression, np.array(rows)

        what = f"springs compressed by {compression[0]:g} and {compression[1]:g} m"
        return self.converged(start, rack, equations, what)[0]

    def converged(
        self, start: Array, rack: float, equations: Callable[[Array], tuple[Array, Array]], what: str
    ) -> tuple[Array, Array, Array]:
        """Coordinates (nq,) that satisfy the joints and further equations, by the Gauss-Newton method.

        `equations`: residuals, shape (m,), and rows, shape (m, nq), of the further equations at coordinates; `what`:
        what they prescribe, for the message. Also returns the rows of all equations, and the derivatives of those of
        the joints by the travel of the rack. Raises `NotReachedError` if the iteration does not converge.
        """
        q, zero_rates = start, np.zeros(len(start))
        for _ in range(MAX_ITERATIONS):
            phi, jacobian, rack_derivative = self.evaluator.constraints(q, zero_rates, rack)
            further, further_rows = equations(q)
            rows, residuals = np.vstack([jacobian, further_rows]), np.concatenate([phi, further])
            step = np.linalg.lstsq(rows, residuals, rcond=RANK_TOLERANCE)[0]
            q = q - step
            if not np.abs(step).max() < 0.5:
                break
            if np.abs(step).max() < CORRECTION_TOLERANCE and np.abs(residuals).max() < RESIDUAL_TOLERANCE:
                return np.asarray(q), rows, rack_derivative
        raise NotReachedError(_not_reached(what, rack))

    def second_derivatives(self, position: Position, directions: Array) -> Array:
        """Second derivatives of the coordinates along directions, shape (nq, n).

        `directions`: rates of the travels of the left and the right wheel and of the rack, shape (3, n).
        """
        zero_rates = np.zeros(len(position.q))

        def rate(qd: Array) -> Array:
            return self.evaluator.convective(position.q, qd, position.rack)

        # the rate of the driving function is 1: gamma(v, s') = a(v, v) + b(v) s' + c s'^2
        rack_term, right_sides = rate(zero_rates), []
        for direction in directions.T:
            forward, backward = (rate(sign * (position.tangent @ direction)) for sign in (1.0, -1.0))
            s = direction[2]
            gamma = 0.5 * (forward + backward) - rack_term + 0.5 * s * (forward - backward) + s**2 * rack_term
            right_sides.append(np.concatenate([-gamma, np.zeros(2)]))
        rows = np.vstack([self.evaluator.jacobian(position.q, position.rack), self._heights])
        return np.asarray(np.linalg.lstsq(rows, np.transpose(right_sides), rcond=RANK_TOLERANCE)[0])

    def steering_motion(self, position: Position) -> Array:
        """Rates of the coordinates per travel of the rack with springs of constant length, shape (nq,).

        The steering axis is defined by this motion.
        """
        zero_rates = np.zeros(len(position.q))
        _, jacobian, rack_derivative = self.evaluator.constraints(position.q, zero_rates, position.rack)
        rows = np.vstack([jacobian, *(self.length(spring, position.q)[1] for spring in self.springs)])
        right_side = np.concatenate([-rack_derivative, np.zeros(2)])
        return np.asarray(np.linalg.lstsq(rows, right_side, rcond=RANK_TOLERANCE)[0])


def _not_reached(what: str, rack: float) -> str:
    """Clause on a position that is not reached."""
    return f"no position with {what} and a rack at {rack:g} m"


def _fixed_chassis(m: Model, car: CarContent) -> Mount:
    """Mount on the ground instead of the chassis."""
    ground = m.ground
    axes = [ground.vector(e) for e in np.eye(3)]
    origin = np.array(car.chassis.reference)
    frame = ground.point(origin), axes, origin
    return Mount(ground, ground, ground, car.chassis.reference, (axes[2], axes[0]), frame)


def _line_names(elements: Mapping[str, object], wheel: str) -> tuple[str, str]:
    """Names of the elements of the spring and the damper of a wheel, which may be the same element."""
    damper = f"damper {wheel}"
    return f"spring {wheel}", damper if damper in elements else f"spring {wheel}"
