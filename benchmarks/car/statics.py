"""Forces of the suspension on the frame of the prototype car at rest, from the equilibrium of each corner."""

from collections.abc import Sequence

import numpy as np

from mbs.scenes import prototype_car
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.part import Part

CAR = prototype_car.car()
# interface node of the frame (without its side) by point of the suspension
FRONT_NODES = {
    "LF": "lower_pivot_front",
    "LR": "lower_pivot_rear",
    "UF": "upper_pivot_front",
    "UR": "upper_pivot_rear",
    "RK": "tie_rod_inner",
    "TF": "spring_upper",
}
REAR_NODES = {"AF": "lower_pivot_front", "AR": "lower_pivot_rear", "TL": "toe_link_inner", "TR": "strut_top"}


def wheel_loads() -> tuple[float, float]:
    """Vertical load of a front and of a rear wheel, N."""
    weight = CAR.vehicle.mass * GRAVITY
    front = weight * (CAR.wheelbase + CAR.vehicle.reference_point[0]) / CAR.wheelbase / 2
    return front, weight / 2 - front


class _Corner:
    """Equilibrium of several bodies with joint forces of known directions and points; axes of the drawing, m and N."""

    def __init__(self, bodies: list[str]) -> None:
        self.bodies = bodies
        self.columns: list[np.ndarray] = []
        self.names: list[tuple[str, np.ndarray]] = []
        self.load = np.zeros(6 * len(bodies))

    def _wrench(self, body: str, force: np.ndarray, point: np.ndarray) -> np.ndarray:
        """Force and moment about the origin on each body, shape (6 n,), of a force on one body; on the frame: zeros."""
        w = np.zeros(6 * len(self.bodies))
        if body in self.bodies:
            offset = 6 * self.bodies.index(body)
            w[offset : offset + 3], w[offset + 3 : offset + 6] = force, np.cross(point, force)
        return w

    def add_joint(
        self, name: str, first: str, second: str, directions: np.ndarray, p1: np.ndarray, p2: np.ndarray
    ) -> None:
        """Add an unknown force on body `first` at p1 along each of `directions` (k, 3), and its reaction on `second` at
        p2.
        """
        for d in directions:
            self.columns.append(self._wrench(first, d, p1) - self._wrench(second, d, p2))
            self.names.append((name, d))

    def add_force(self, body: str, force: np.ndarray, point: np.ndarray) -> None:
        """Add a known force, N, on a body at a point."""
        self.load += self._wrench(body, force, point)

    def solve(self) -> dict[str, np.ndarray]:
        """Joint forces by name, N: the solution of minimum norm, so that hinges carry equal parts of an axial force."""
        G = np.array(self.columns).T
        x, *_ = np.linalg.lstsq(G, -self.load, rcond=1e-10)
        if not np.allclose(G @ x, -self.load, atol=1e-8 * np.abs(self.load).max()):
            raise RuntimeError(f"The bodies {', '.join(self.bodies)} cannot be in equilibrium.")
        forces: dict[str, np.ndarray] = {}
        for (name, d), value in zip(self.names, x, strict=True):
            forces[name] = forces.get(name, np.zeros(3)) + value * d
        return forces


def _add_weight(c: _Corner, body: str, data: Part) -> None:
    c.add_force(body, np.array([0.0, 0.0, -data.mass * GRAVITY]), np.array(data.com))


def front_forces() -> dict[str, np.ndarray]:
    """Forces on the left front interfaces of the frame, N."""
    p = {k: np.array(v) for k, v in CAR.front.suspension.points}
    c = _Corner(["lower", "upper", "upright"])
    axes = np.eye(3)
    for end, node in (("front", "F"), ("rear", "R")):
        for arm, letter in (("lower", "L"), ("upper", "U")):
            point = p[f"{arm}_pivot_{end}"]
            c.add_joint(letter + node, "frame", arm, axes, point, point)
    for arm in ("lower", "upper"):
        point = p[f"{arm}_ball_joint"]
        c.add_joint(f"ball {arm}", arm, "upright", axes, point, point)
    spring = p["spring_upper"] - p["spring_lower"]
    c.add_joint("TF", "frame", "lower", (spring / np.linalg.norm(spring))[None], p["spring_upper"], p["spring_lower"])
    rod = p["tie_rod_inner"] - p["tie_rod_outer"]
    c.add_joint("RK", "frame", "upright", (rod / np.linalg.norm(rod))[None], p["tie_rod_inner"], p["tie_rod_outer"])
    for body, name in (("lower", "lower_wishbone"), ("upper", "upper_wishbone"), ("upright", "upright")):
        _add_weight(c, body, getattr(CAR.front.suspension.bodies, name))
    tyre_force = wheel_loads()[0] - CAR.front.wheel.mass * GRAVITY
    c.add_force("upright", np.array([0.0, 0.0, tyre_force]), np.array(CAR.front.wheel.centre))
    solution = c.solve()
    return {n: solution[n] for n in FRONT_NODES}


def rear_forces() -> dict[str, np.ndarray]:
    """Forces on the left rear interfaces of the frame, N."""
    p = {k: np.array(v) for k, v in CAR.rear.suspension.points}
    c = _Corner(["arm", "upright"])
    axes = np.eye(3)
    for end, node in (("front", "AF"), ("rear", "AR")):
        c.add_joint(node, "frame", "arm", axes, p[f"lower_pivot_{end}"], p[f"lower_pivot_{end}"])
    c.add_joint("ball", "arm", "upright", axes, p["lower_ball_joint"], p["lower_ball_joint"])
    c.add_joint("TR", "frame", "upright", axes, p["strut_top"], p["strut_top"])
    rod = p["toe_link_inner"] - p["toe_link_outer"]
    c.add_joint("TL", "frame", "upright", (rod / np.linalg.norm(rod))[None], p["toe_link_inner"], p["toe_link_outer"])
    bodies = CAR.rear.suspension.bodies
    _add_weight(c, "arm", bodies.lower_arm)
    _add_weight(c, "upright", bodies.upright)
    tyre_force = wheel_loads()[1] - CAR.rear.wheel.mass * GRAVITY
    c.add_force("upright", np.array([0.0, 0.0, tyre_force]), np.array(CAR.rear.wheel.centre))
    solution = c.solve()
    return {n: solution[n] for n in REAR_NODES}


def interface_forces(names: Sequence[str], front_factor: float = 1.0, rear_factor: float = 1.0) -> np.ndarray:
    """Forces on the interfaces `names` (node names with side), shape (3 n,), N."""
    left_side = {n: front_factor * f for n, f in front_forces().items()}
    left_side |= {n: rear_factor * f for n, f in rear_forces().items()}
    return np.concatenate([left_side[n[:-1]] * (np.array([1, -1, 1]) if n[-1] == "R" else 1) for n in names])
