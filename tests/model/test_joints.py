"""Each joint leaves the degrees of freedom it should, keeps its condition in motion and conserves momentum."""

import numpy as np
import pytest

from mbs import Model, ModelError, Simulation, compile

CLOSED = 1e-9  # m, condition of a joint along a run
MOMENTUM = 1e-8  # relative
STEP = 0.005
POINT = (0.3, 0.1, -0.2)
AXIS = (0.2, 1.0, -0.4)
OTHER = (1.0, 0.1, 0.3)


def pair(dimension=3):
    """Two bodies that fly freely with different velocities."""
    m = Model("pair", dimension=dimension, gravity=np.zeros(dimension))
    coms = np.array([(0.0, 0.0, 0.0), (0.8, 0.3, -0.1)])[:, :dimension]
    inertias = (0.2, 0.1) if dimension == 2 else ((0.2, 0.25, 0.3), (0.1, 0.12, 0.2))
    one = m.body("one", mass=1.5, com=coms[0], inertia=inertias[0])
    two = m.body("two", mass=0.8, com=coms[1], inertia=inertias[1])
    spin = (1.0, -2.0) if dimension == 2 else ((0.4, -1.0, 0.8), (-1.2, 0.5, 1.5))
    m.initial_velocity(one, linear=(0.3, -0.2, 0.5)[:dimension], angular=spin[0])
    m.initial_velocity(two, linear=(-0.4, 0.1, 0.2)[:dimension], angular=spin[1])
    for body in (one, two):
        for c in "xyz"[:dimension]:
            m.sense_position(f"{body.name}.v{c}", body, None, c, order=1)
    m.sense_energy("energy", "kinetic")
    return m, one, two


def momentum(trajectory, dimension):
    return np.array([1.5 * trajectory[f"one.v{c}"] + 0.8 * trajectory[f"two.v{c}"] for c in "xyz"[:dimension]])


JOINTS = {
    "revolute": (7, lambda m, a, b: m.revolute("j", a, b, point=POINT, axis=AXIS)),
    "spherical": (9, lambda m, a, b: m.spherical("j", a, b, point=POINT)),
    "universal": (8, lambda m, a, b: m.universal("j", a, b, point=POINT, axis_1=AXIS, axis_2=OTHER)),
    "prismatic": (7, lambda m, a, b: m.prismatic("j", a, b, point=POINT, axis=AXIS)),
    "cylindrical": (8, lambda m, a, b: m.cylindrical("j", a, b, point=POINT, axis=AXIS)),
    "weld": (6, lambda m, a, b: m.weld("j", a, b)),
    "point_on_line": (10, lambda m, a, b: m.point_on_line("j", (a, POINT), (b, POINT), axis=AXIS)),
    "distance": (11, lambda m, a, b: m.distance("j", (a, POINT), (b, (1.0, 0.4, 0.5)))),
}
PLANAR = {
    "revolute": (4, lambda m, a, b: m.revolute("j", a, b, point=POINT[:2])),
    "prismatic": (4, lambda m, a, b: m.prismatic("j", a, b, point=POINT[:2], axis=AXIS[:2])),
    "point_on_line": (5, lambda m, a, b: m.point_on_line("j", (a, POINT[:2]), (b, POINT[:2]), axis=AXIS[:2])),
    "weld": (3, lambda m, a, b: m.weld("j", a, b)),
    "distance": (5, lambda m, a, b: m.distance("j", (a, POINT[:2]), (b, (1.0, 0.4)))),
}
CASES = [(3, k, *v) for k, v in JOINTS.items()] + [(2, k, *v) for k, v in PLANAR.items()]


@pytest.mark.parametrize(("dimension", "kind", "freedoms", "join"), CASES, ids=[f"{k}-{d}d" for d, k, *_ in CASES])
def test_freedoms_condition_and_momentum(dimension, kind, freedoms, join):
    m, one, two = pair(dimension)
    condition = watch(m, kind, one, two, dimension)
    join(m, one, two)
    system = compile(m)
    assert system.report["degrees_of_freedom"] == freedoms
    trajectory = Simulation(system).run(1.0, STEP)
    p = momentum(trajectory, dimension)
    assert np.max(np.abs(p - p[:, :1])) < MOMENTUM * np.linalg.norm(p[:, 0])
    assert np.linalg.norm(p[:, 0]) > 0.1
    assert trajectory["energy"][0] > 0.03
    for name, expected in condition.items():
        assert np.max(np.abs(trajectory[name] - expected)) < CLOSED, name


def watch(m, kind, one, two, dimension):
    """Sensors that the joint must hold at a value."""
    p = np.array(POINT[:dimension])
    gap = one.point(p) - two.point(p)
    u = np.array(AXIS[:dimension]) / np.linalg.norm(AXIS[:dimension])
    gaps = {}
    if kind in ("revolute", "spherical", "universal", "weld"):
        m.sense_vector("gap", gap)
        gaps["gap"] = 0.0
    if dimension == 3 and kind in ("revolute", "cylindrical", "prismatic", "weld"):
        m.sense_vector("axis gap", one.vector(u) - two.vector(u))
        gaps["axis gap"] = 0.0
    if kind in ("prismatic", "weld"):
        x = np.eye(dimension)[0]
        m.sense_vector("turn", one.vector(x) - two.vector(x))
        gaps["turn"] = 0.0
    if kind == "distance":
        end = np.array((1.0, 0.4, 0.5)[:dimension])
        m.sense_vector("length", one.point(p) - two.point(end))
        gaps["length"] = float(np.linalg.norm(p - end))
    return gaps


@pytest.mark.parametrize("kind", ["point_on_line", "cylindrical", "prismatic"])
def test_the_point_of_a_sliding_joint_stays_on_its_line(kind):
    m, one, two = pair(3)
    JOINTS[kind][1](m, one, two)
    for c in "xyz":
        m.sense_position(f"p{c}", one, POINT, c)
        m.sense_position(f"o{c}", two, POINT, c)
        m.sense_position(f"t{c}", two, np.array(POINT) + np.array(AXIS), c)
    t = Simulation(compile(m)).run(1.0, STEP)
    gap = np.array([t[f"p{c}"] - t[f"o{c}"] for c in "xyz"]).T
    along = np.array([t[f"t{c}"] - t[f"o{c}"] for c in "xyz"]).T
    assert np.max(np.abs(np.cross(gap, along))) < CLOSED
    assert np.max(np.linalg.norm(gap, axis=1)) > 0.1


@pytest.mark.parametrize(
    ("act", "sentence"),
    [
        (lambda m, a, b: m.revolute("j", a, b, point=(0, 0, 0)), "needs an axis"),
        (lambda m, a, b: m.revolute("j", a, a, point=(0, 0, 0), axis=(0, 0, 1)), "with itself"),
        (lambda m, a, b: m.revolute("j", a, b, point=(0, 0, 0), axis=(0, 0, 0)), "is zero"),
        (lambda m, a, b: m.universal("j", a, b, point=(0, 0, 0), axis_1=(1, 0, 0), axis_2=(2, 0, 0)), "parallel"),
        (lambda m, a, b: m.distance("j", (a, (1, 0, 0)), (b, (1, 0, 0))), "zero length"),
        (lambda m, a, b: m.distance("j", (a, (1, 0, 0)), (b, (0, 0, 0)), length=-1.0), "greater than zero"),
        (lambda m, a, b: m.distance("j", (m.ground, (1, 0, 0)), (m.ground, (0, 0, 0))), "two points of the ground"),
    ],
)
def test_impossible_joints_are_refused(act, sentence):
    m, one, two = pair()
    with pytest.raises(ModelError) as error:
        act(m, one, two)
    assert sentence in str(error.value)
    assert "'j'" in str(error.value)
