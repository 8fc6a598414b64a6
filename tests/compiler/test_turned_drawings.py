"""Two joints between a body and the ground, drawn along the axes and anywhere: the same freedoms, the same motion."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs import Model, ModelError, compile, simulate
from mbs.model.body import Body

EX, EY, EZ = np.eye(3)
Join = Callable[[Model, str, Body, np.ndarray, np.ndarray], object]
JOINTS: dict[str, Join] = {
    "revolute z": lambda m, n, b, p, R: m.revolute(n, m.ground, b, point=p, axis=R @ EZ),
    "revolute x": lambda m, n, b, p, R: m.revolute(n, m.ground, b, point=p, axis=R @ EX),
    "cylindrical": lambda m, n, b, p, R: m.cylindrical(n, m.ground, b, point=p, axis=R @ EZ),
    "prismatic": lambda m, n, b, p, R: m.prismatic(n, m.ground, b, axis=R @ EZ, point=p),
    "spherical": lambda m, n, b, p, R: m.spherical(n, m.ground, b, point=p),
    "universal": lambda m, n, b, p, R: m.universal(n, m.ground, b, point=p, axis_1=R @ EX, axis_2=R @ EY),
    "on a line": lambda m, n, b, p, R: m.point_on_line(n, (m.ground, p), (b, p), axis=R @ EZ),
}
PLACES = (0.0 * EX, EZ, 0.7 * EX + 0.4 * EZ)


def moved(joints: tuple[str, str], place: int, R: np.ndarray, o: np.ndarray) -> tuple[int, np.ndarray]:
    """Freedoms, and where a point of the body is after a tenth of a second, as in the plain drawing."""
    m = Model("pair", gravity=R @ np.array([1.0, -9.0, 2.0]))
    inertia = R @ np.diag([0.1, 0.2, 0.15]) @ R.T
    body = m.body("body", mass=1.0, com=o + R @ np.array([0.3, 0.2, 0.5]), inertia=inertia)
    for name, at in zip(joints, (0, place), strict=True):
        JOINTS[name](m, f"{name} {at}", body, o + R @ PLACES[at], R)
    for axis in "xyz":
        m.sense_position(axis, body, o + R @ np.array([0.5, 0.1, 0.2]), axis)
    system = compile(m)
    run = simulate(system, 0.1, 0.005, progress=False, estimate_error=False)
    return system.meta["report"]["degrees_of_freedom"], R.T @ (np.array([run[a][-1] for a in "xyz"]) - o)


@pytest.mark.slow
def test_a_drawing_that_is_turned_and_moved_moves_as_before() -> None:
    """Round-off that was left of a condition was one of its own: what turns stood still, or did not start."""
    rng = np.random.default_rng(7)
    wrong = []
    for first, second in itertools.combinations_with_replacement(JOINTS, 2):
        for place in (1, 2):
            R, o = Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix(), 10.0 * rng.normal(size=3)
            try:
                freedoms, end = moved((first, second), place, np.eye(3), np.zeros(3))
            except ModelError:  # nothing can move
                with pytest.raises(ModelError):
                    moved((first, second), place, R, o)
                continue
            try:
                again, other = moved((first, second), place, R, o)
            except Exception as error:  # every row is told
                wrong.append((first, second, place, str(error)))
                continue
            if again != freedoms or np.abs(other - end).max() > 1e-9:
                wrong.append((first, second, place, f"{freedoms} and {again}, {end} and {other}"))
    assert not wrong
