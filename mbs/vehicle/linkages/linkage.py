"""Suspension of an axle on a fixed chassis as a mechanism with prescribed travel of wheels and rack.

Of the car's templates the model has joints, springs and bars, but no tyres, brakes or gravity. With Phi(q, s) the
conditions of the joints, s the rack's travel and c_z the heights of both wheel centres, a position solves

    Phi(q, s) = 0,    c_z(q) = c_z(drawn) + travel,

by Gauss's and Newton's method: each correction is the shortest one that the linearised equations allow, so that
redundant rows do no harm. The tangent of the position follows from the same matrix, and its derivative along a
direction from d(Phi_q)/dt qd: nothing is differenced.
"""

from collections.abc import Mapping
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
from mbs.vehicle.linkages.standing_model import StandingModel
from mbs.vehicle.side import Point, Side
from mbs.vehicle.steering.rack_section import rack_ends
from mbs.vehicle.suspensions.anti_roll_bar import LINK

Array = NDArray[np.float64]

SIDES = ("left", "right")
FARTHEST = 1.0  # m: travel of the rack that the guide can give
CLOSE = 1e-11  # m: a correction that ends the iteration
MOST_ITERATIONS = 12
LEFT_OVER = 1e-9  # of rows that have no solution, in the unit of the rows


class NotReachedError(ValueError):
    """A position that the linkage cannot take."""


@dataclass(frozen=True)
class Position:
    """Position of the linkage, and its motion from there to first order."""

    travel: Array
    """Shape (2,): of the left and the right wheel centre along z from the drawing, m, positive in bump."""
    rack: float
    """Travel of the rack from the drawing, m, positive to the left."""
    q: Array
    """Shape (nq,): coordinates."""
    tangent: Array
    """Shape (nq, 3): their derivatives with respect to the travel of the left wheel, of the right wheel and of the
    rack."""


class Linkage(StandingModel):
    """The suspension of one axle.

    Parameters
    ----------
    car : Car
        Without faults.

    Attributes
    ----------
    model : Model
        Its model, on the earth as the chassis.
    drawn : Position
        As the file draws it.
    has_rod : bool
        Whether a rod steers the wheels, which a twist beam has not.
    springs, dampers : tuple of AffineVector
        From one end to the other, of the left and the right side.
    levers : tuple of int
        Numbers of the full coordinates of the levers of the anti-roll bar; empty: there is none.
    """

    def __init__(self, car: CarContent, axle: str) -> None:
        self.car, self.name, self.data = car, axle, getattr(car, axle)
        self.data.suspension.needs_links()
        m = self.model = Model(f"{car.name} {axle} suspension", gravity=(0.0, 0.0, 0.0))
        b = CarBuilder(m, m.road(PlaneRoad()), {})
        b.chassis = _fixed_chassis(m, car)
        ramp = PPoly(np.array([[1.0], [-FARTHEST]]), np.array([-FARTHEST, FARTHEST]))  # the rack's travel is the time
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

    def constraints(self, q: Array, qd: Array, rack: float) -> tuple[Array, Array, Array]:
        """Conditions of the joints at a travel of the rack, their Jacobian, and their rate by the rack's travel.

        `q`, `qd`: coordinates and rates, shape (nq,).
        """
        return self.evaluator.constraints(q, qd, rack)

    def centre(self, side: int) -> tuple[Array, Array]:
        """Matrix and constant of a wheel's centre; `side` is 0 for left and 1 for right."""
        return self._centres[side]

    def triad(self, side: int) -> list[tuple[Array, Array]]:
        """Matrices and constants of unit vectors of a wheel's carrier: forward, the wheel's axis, up in its plane."""
        return self._triads[side]

    def loaded_radius(self, side: int) -> float:
        """Distance from the wheel centre down in the wheel plane to the ground as drawn, m."""
        *_, up = self.data.alignment.axes(self._corners[side].side)
        return float(self.data.wheel.centre[2] / up[2])

    def solve(self, start: Array, travel: Array, rack: float) -> Position:
        """The position near a start.

        `start`: coordinates near to it, shape (nq,); `travel`: of the left and the right wheel, m, shape (2,); `rack`:
        travel of the rack, m. Raises `NotReachedError`: the iteration does not end: links are too short or too long for
        it.
        """
        q, still, heights = start.copy(), np.zeros(len(start)), self._drawn_heights + travel
        offset = np.array([centre[1][2] for centre in self._centres])
        for _ in range(MOST_ITERATIONS):
            phi, jacobian, ahead = self.evaluator.constraints(q, still, rack)
            rows = np.vstack([jacobian, self._heights])
            residuals = np.concatenate([phi, self._heights @ q + offset - heights])
            step = np.linalg.lstsq(rows, residuals, rcond=RANK_TOLERANCE)[0]
            q = q - step
            if not np.abs(step).max() < 0.5:
                break
            if np.abs(step).max() < CLOSE and np.abs(residuals).max() < LEFT_OVER:
                right_side = np.zeros((len(residuals), 3))
                right_side[-2, 0] = right_side[-1, 1] = 1.0
                right_side[: len(phi), 2] = -ahead
                tangent = np.linalg.lstsq(rows, right_side, rcond=RANK_TOLERANCE)[0]
                if np.abs(rows @ tangent - right_side).max() > 1e-6:
                    break  # at a dead point the wheels cannot go on
                return Position(travel, rack, q, tangent)
        raise NotReachedError(f"no position with travels of {travel[0]:g} and {travel[1]:g} m and a rack at {rack:g} m")

    def bends(self, at: Position, directions: Array) -> Array:
        """Second derivatives (nq, n) of the coordinates along directions.

        `directions`: rates of the travels of the left and the right wheel and of the rack, shape (3, n).
        """
        still = np.zeros(len(at.q))

        def rate(qd: Array) -> Array:
            return self.evaluator.convective(at.q, qd, at.rack)

        # the guide's own rate is 1: gamma(v, s') = a(v, v) + b(v) s' + c s'^2
        alone, right_sides = rate(still), []
        for direction in directions.T:
            ahead, back = (rate(sign * (at.tangent @ direction)) for sign in (1.0, -1.0))
            s = direction[2]
            gamma = 0.5 * (ahead + back) - alone + 0.5 * s * (ahead - back) + s**2 * alone
            right_sides.append(np.concatenate([-gamma, np.zeros(2)]))
        rows = np.vstack([self.evaluator.jacobian(at.q, at.rack), self._heights])
        return np.asarray(np.linalg.lstsq(rows, np.transpose(right_sides), rcond=RANK_TOLERANCE)[0])

    def steering_motion(self, at: Position) -> Array:
        """Rates (nq,) of the coordinates per travel of the rack with springs of constant length.

        So a steering axis is defined: the suspension stands, the rod turns the wheel.
        """
        still = np.zeros(len(at.q))
        _, jacobian, ahead = self.evaluator.constraints(at.q, still, at.rack)
        rows = [jacobian]
        for spring in self.springs:
            D, d = self.linear(spring)
            line_vector = D @ at.q + d
            rows.append((line_vector @ D / np.linalg.norm(line_vector))[None])
        right_side = np.concatenate([-ahead, np.zeros(2)])
        return np.asarray(np.linalg.lstsq(np.vstack(rows), right_side, rcond=RANK_TOLERANCE)[0])


def _fixed_chassis(m: Model, car: CarContent) -> Mount:
    """The earth as the chassis."""
    ground = m.ground
    axes = [ground.vector(e) for e in np.eye(3)]
    origin = np.array(car.chassis.reference)
    frame = ground.point(origin), axes, origin
    return Mount(ground, ground, ground, car.chassis.reference, (axes[2], axes[0]), frame)


def _line_names(elements: Mapping[str, object], wheel: str) -> tuple[str, str]:
    """Names of spring and damper of a wheel, which may be one."""
    damper = f"damper {wheel}"
    return f"spring {wheel}", damper if damper in elements else f"spring {wheel}"
