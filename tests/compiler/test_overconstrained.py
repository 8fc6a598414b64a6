"""Overconstrained loops drawn with rounded or shifted numbers: compile corrects the drawing, and every method runs."""

import importlib

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbs import Model, ModelError, SimulationError, compile, simulate
from mbs.settings.settings import METHODS
from tests.compiler import overconstrained_loops as drawn
from tests.quick import quick

overconstrained = importlib.import_module("mbs.compiler.overconstrained")

LOOPS = {
    "Bennett": drawn.bennett,
    "Bricard": drawn.bricard,
    "parallelogram": drawn.parallelogram,
    "redundant crank": drawn.redundant_rod,
    "redundant rod": lambda pen: drawn.redundant_rod(pen, rods=True),
    "carried parallelogram": lambda pen: drawn.redundant_rod(pen, five=True),
}
FREEDOMS = {"carried parallelogram": 2}
END = 0.3  # s
STEP = 0.005  # s


def motion(system, method):
    """Positions of the point (n, d) and the range of the energy, J."""
    run = simulate(system, END, STEP, method=method)
    columns = np.array([run[name] for name in run]).T
    return columns[:, :-1], np.ptp(columns[:, -1])


def methods_of(loop):
    """All for the first loop."""
    return METHODS if loop == "Bennett" else ("ali3p", "energy_momentum_4", "semi_recursive")


@pytest.fixture(scope="module")
def exact():
    """Motion of the exact loops by loop and method; None where the method does not take the loop."""
    results = {}
    for loop, build in LOOPS.items():
        system = compile(build(drawn.exact))
        for method in methods_of(loop):
            try:
                results[loop, method] = motion(system, method)
            except SimulationError as error:
                if not method.startswith("semi_recursive") or "this method needs" not in str(error):
                    raise
                results[loop, method] = None
    return results


@pytest.mark.slow
@pytest.mark.parametrize("loop", LOOPS)
def test_all_methods_move_a_shifted_drawing_as_the_exact_one(loop, exact):
    for size, methods in ((2e-5, methods_of(loop)), (1e-11, ("ali3p",))):
        system = compile(LOOPS[loop](drawn.shifted(size)))
        report = system.meta["report"]
        assert report["degrees_of_freedom"] == FREEDOMS.get(loop, 1)
        assert max((max(c) for c in report["closed"].values()), default=0.0) < 5.0 * size
        for method in methods:
            if exact[loop, method] is None:
                continue
            aim, energy = exact[loop, method]
            path, own = motion(system, method)
            assert np.max(np.abs(path - aim)) < 10.0 * size + 2e-8, method
            assert own < 1.1 * energy + 1e-6, method


def test_a_loop_drawn_as_exactly_as_its_numbers_allow_is_left_alone():
    for loop, build in LOOPS.items():
        assert overconstrained.corrected_joints(build(drawn.exact)) == [], loop


def test_the_report_names_the_joint_and_the_distance():
    system = compile(drawn.bennett(drawn.shifted(1e-5)))
    closed = system.meta["report"]["closed"]
    assert set(closed) == set("ABCD")
    distance, angle = max(closed.values(), key=max)
    assert f"closes by {distance:.2g} m, {angle:.2g} rad, the largest of 4" in str(system)
    assert 1e-6 < max(distance, angle) < 3e-5
    assert "closes by" not in str(compile(drawn.bennett()))


@pytest.mark.parametrize("loop", ["Bennett", "redundant crank"])
def test_beyond_the_tolerance_the_loop_is_refused_with_joint_distance_and_remedy(loop):
    build = LOOPS[loop]
    with pytest.raises(ModelError, match=r"cannot move as drawn.*'.*' by .* m.* are allowed\. Draw it more exactly"):
        compile(build(drawn.shifted(1e-3, seed=1)))


@pytest.mark.slow
def test_a_larger_tolerance_takes_it():
    model = drawn.bennett(drawn.shifted(1e-3))
    with pytest.raises(ModelError, match=r"tolerance=0\.0007;"):
        compile(model)
    assert compile(model, tolerance=0.0007).meta["report"]["degrees_of_freedom"] == 1
    assert compile(drawn.bennett(drawn.shifted(1e-6)), tolerance=0.0).meta["report"]["closed"] == {}
    with pytest.raises(ModelError, match="The tolerance of compile is"):
        compile(model, tolerance=0.5)


def test_the_model_is_as_drawn_afterwards():
    model = drawn.bennett(drawn.shifted(1e-5))
    before = [(j.equations, j.places) for j in model.joints]
    points = [np.array(b.joint_points) for b in model.bodies]
    first = compile(model).to_bytes()
    assert [(j.equations, j.places) for j in model.joints] == before
    assert all(np.array_equal(p, b.joint_points) for p, b in zip(points, model.bodies, strict=True))
    assert compile(model).to_bytes() == first


def test_points_drawn_apart_on_both_bodies_are_closed_too():
    """A pair of points that miss each other by 3e-5 m, in a loop that has no play for it."""
    m = Model("four hinges", dimension=3)
    points, axes = drawn.bennett_joints()
    random = np.random.default_rng(7)
    bodies = [m.ground]
    for k in range(3):
        bodies.append(m.body(f"link {k}", mass=1.0, com=0.5 * (points[k] + points[k + 1]), inertia=(0.1, 0.1, 0.1)))
    for k in range(4):
        pair = [points[k] + 2e-5 * random.uniform(-1.0, 1.0, 3) for _ in range(2)]
        axis = [axes[k] + 2e-5 * random.uniform(-1.0, 1.0, 3) for _ in range(2)]
        m.revolute("ABCD"[k], bodies[k], bodies[(k + 1) % 4], point=tuple(pair), axis=tuple(axis))
    m.sense_position("x", bodies[1], points[1], "x")
    m.sense_energy("energy")
    system = compile(m)
    assert system.meta["report"]["degrees_of_freedom"] == 1
    assert 1e-6 < max(d for d, _ in system.meta["report"]["closed"].values()) < 1e-4
    path, energy = motion(system, "energy_momentum")
    assert np.ptp(path) > 0.01
    assert energy < 1e-9


def test_a_short_crank_is_no_closing_error():
    """A crank of 1e-4 of the mechanism turns; nothing is redundant, and nothing may be moved."""
    m = Model("eccentric", dimension=2)
    crank = m.body("crank", mass=1.0, com=(0.0, 0.0), inertia=1e-3)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    rocker = m.body("rocker", mass=1.0, com=(1.0, 0.5), inertia=0.1)
    m.revolute("A", m.ground, crank, point=(0.0, 0.0))
    m.revolute("B", crank, rod, point=(0.0, 1e-4))
    m.revolute("C", rod, rocker, point=(1.0, 0.0))
    m.revolute("D", m.ground, rocker, point=(1.0, 1.0))
    assert overconstrained.corrected_joints(m) == []
    assert compile(m).meta["report"]["degrees_of_freedom"] == 1


def test_a_frame_that_stands_is_a_model():
    """A square with a diagonal does not move and does not nearly move."""
    m = Model("frame", dimension=2)
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    bars = [m.body(f"bar {k}", mass=1.0, com=0.5 * (corners[k] + corners[k + 1]), inertia=0.1) for k in range(3)]
    for k, (first, second) in enumerate(zip([m.ground, *bars], [*bars, m.ground], strict=True)):
        m.revolute("ABCD"[k], first, second, point=corners[k])
    m.distance("diagonal", (m.ground, corners[0]), (bars[1], corners[2]))
    system = compile(m)
    assert system.meta["report"]["degrees_of_freedom"] == 0
    assert "nothing can move" in str(system)
    assert simulate(system, 0.1, 0.01).notices == ("Nothing moves: the joints of 'frame' leave no freedom.",)


def test_the_moment_of_a_corrected_joint_can_be_read():
    """Its rows are made again with the corrected axes; how a redundant loop shares its forces hangs on the drawing."""

    def moment(pen):
        m = drawn.bennett(pen)
        m.sense_joint("moment", "B", "x", "moment")
        return simulate(compile(m), END, STEP)["moment"]

    aim = moment(drawn.exact)
    assert np.abs(aim).max() > 0.05
    assert np.abs(moment(drawn.shifted(1e-6)) - aim).max() < 0.02 * np.abs(aim).max()


def test_a_gate_on_two_hinges_turns_however_little_their_axes_differ():
    """What round-off had left of an equation was solved for a coordinate: the gate stood still, or was refused."""
    ends = []
    for apart in (0.0, 1e-16, 1e-10, 1e-4):
        m = Model("gate", gravity=(0.0, -9.81, 0.0))
        gate = m.body("gate", mass=1.0, com=(0.5, 0.0, 0.5), inertia=(0.1, 0.1, 0.1))
        m.revolute("low", m.ground, gate, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
        m.revolute("high", m.ground, gate, point=(0.0, 0.0, 1.0), axis=(apart, 0.0, 1.0))
        m.sense_position("y", gate, (0.5, 0.0, 0.5), "y")
        system = compile(m)
        assert system.meta["report"]["degrees_of_freedom"] == 1, apart
        ends.append(simulate(system, 0.2, 0.002, progress=False)["y"][-1])
    assert ends == pytest.approx([ends[0]] * len(ends), rel=1e-8)


def rise_of_a_lift():
    """Of the plate in END, m: one freedom, the angle of the bars, under J angle'' + J' angle'^2 / 2 = -weight cos."""
    L, start = np.hypot(1.6, 0.6), np.arctan2(0.6, 1.6)

    def inertia(angle):
        return L**2 * (0.5 * np.sin(angle) ** 2 + 5.5 * np.cos(angle) ** 2) + 0.4

    def rates(t, y):
        change = -10.0 * L**2 * np.sin(y[0]) * np.cos(y[0])
        return y[1], -(9.81 * L * 6.0 * np.cos(y[0]) + 0.5 * change * y[1] ** 2) / inertia(y[0])

    end = solve_ivp(rates, (0.0, END), (start, 0.0), rtol=1e-10, atol=1e-12).y[0, -1]
    return L * (np.sin(end) - np.sin(start))


@pytest.mark.slow
@pytest.mark.parametrize("guide", quick(("line",), ("line", "column", "head"), "proof"))
def test_a_redundant_guide_is_corrected_or_refused_and_never_stands_in_silence(guide):
    """Joints that coincide but for the error of the drawing are no short link."""
    for error in (0.0, 1e-10, 1e-7, 2e-5, 1e-2):
        turn, scale = (0.7, 0.05) if error else (0.0, 1.0)
        model = drawn.scissor_lift(drawn.shifted(error, seed=5) if error else drawn.exact, guide, turn, scale)
        if error > 2e-5:
            with pytest.raises(ModelError, match="Draw it more exactly|cannot be closed; these joints stay open"):
                compile(model)
            continue
        system = compile(model)
        report = system.meta["report"]
        assert report["degrees_of_freedom"] == 1, error
        assert bool(report["closed"]) == (error > 0.0)
        run = simulate(system, END, STEP)
        x, y = (run[c][-1] - run[c][0] for c in "xy")
        rise = (y * np.cos(turn) - x * np.sin(turn)) / scale
        assert rise == pytest.approx(rise_of_a_lift(), rel=2e-4, abs=30.0 * error)


def test_short_links_keep_their_length():
    """The correction is of the size of the drawing's error, not of the link, however short that is."""
    length, error = 1e-4, 5e-7
    joints = overconstrained.corrected_joints(drawn.three_short_cranks(drawn.shifted(error), length))
    assert joints
    assert max(j.correction.distance for j in joints) < 2.0 * error + 1e-15
    assert compile(drawn.three_short_cranks(drawn.shifted(error), length)).meta["report"]["degrees_of_freedom"] == 1
