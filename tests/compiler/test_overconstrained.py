"""Overconstrained loops drawn with rounded or shifted numbers: compile corrects the drawing, and every method runs."""

import importlib
from functools import partial

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
    "Sarrus": drawn.sarrus,
    "Bricard": drawn.bricard,
    "parallelogram": drawn.parallelogram,
    "redundant crank": drawn.redundant_rod,
    "redundant rod": lambda pen: drawn.redundant_rod(pen, rods=True),
    "carried parallelogram": lambda pen: drawn.redundant_rod(pen, five=True),
    "two storeys": drawn.double_parallelogram,
}
FREEDOMS = {"carried parallelogram": 2, "two storeys": 2}
END = 0.3  # s
STEP = 0.005  # s


def motion(system, method):
    """Positions of the point (n, d) and the range of the energy, J."""
    run = simulate(system, END, STEP, method=method)
    columns = np.array([run[name] for name in run]).T
    return columns[:, :-1], np.ptp(columns[:, -1])


@pytest.fixture(scope="module")
def exact():
    """Motion of the exact loops by loop and method; None where the method does not take the loop."""
    results = {}
    for loop, build in LOOPS.items():
        system = compile(build(drawn.exact))
        for method in METHODS:
            try:
                results[loop, method] = motion(system, method)
            except SimulationError as error:
                if not method.startswith("semi_recursive") or "this method needs" not in str(error):
                    raise
                results[loop, method] = None
    return results


@pytest.mark.parametrize("loop", LOOPS)
@pytest.mark.parametrize("size", [2e-5, 1e-8, 1e-11])
def test_all_methods_move_a_shifted_drawing_as_the_exact_one(loop, size, exact):
    system = compile(LOOPS[loop](drawn.shifted(size)))
    report = system.meta["report"]
    assert report["degrees_of_freedom"] == FREEDOMS.get(loop, 1)
    assert max((max(c) for c in report["closed"].values()), default=0.0) < 5.0 * size
    for method in METHODS:
        if exact[loop, method] is None:
            continue
        aim, energy = exact[loop, method]
        path, own = motion(system, method)
        assert np.max(np.abs(path - aim)) < 10.0 * size + 2e-8, method
        assert own < 1.1 * energy + 1e-6, method


def test_a_loop_drawn_as_exactly_as_its_numbers_allow_is_left_alone():
    for loop, build in LOOPS.items():
        assert overconstrained.corrected_joints(build(drawn.exact)) == [], loop


@pytest.mark.parametrize("decimals", [4, 6, 8, 12])
def test_bennett_with_so_many_decimals(decimals, exact):
    system = compile(drawn.bennett(drawn.rounded(decimals)))
    assert set(system.meta["report"]["closed"]) == set("ABCD")
    for method in METHODS:
        aim, _ = exact["Bennett", method]
        path, _ = motion(system, method)
        assert np.max(np.abs(aim[-1] - aim[0])) > 0.05  # it does move
        assert np.max(np.abs(path - aim)) < 10.0 ** (1 - decimals) + 2e-8, method


def test_the_report_names_the_joint_and_the_distance():
    system = compile(drawn.bennett(drawn.shifted(1e-5)))
    closed = system.meta["report"]["closed"]
    distance, angle = max(closed.values(), key=max)
    assert f"closes by {distance:.2g} m, {angle:.2g} rad, the largest of 4" in str(system)
    assert 1e-6 < max(distance, angle) < 3e-5
    assert "closes by" not in str(compile(drawn.bennett()))


@pytest.mark.parametrize("loop", ["Bennett", "Sarrus", "Bricard", "parallelogram", "redundant crank", "two storeys"])
def test_beyond_the_tolerance_the_loop_is_refused_with_joint_distance_and_remedy(loop):
    build = LOOPS[loop]
    with pytest.raises(ModelError, match=r"stands still as drawn.*'.*' by .* m.* are allowed\. Draw it more exactly"):
        compile(build(drawn.shifted(1e-3, seed=1)))


@pytest.mark.slow
def test_a_larger_tolerance_takes_it():
    model = drawn.bennett(drawn.shifted(1e-3))
    with pytest.raises(ModelError, match=r"tolerance=0\.0007;"):
        compile(model)
    assert compile(model, tolerance=0.0007).meta["report"]["degrees_of_freedom"] == 1
    assert compile(drawn.bennett(drawn.shifted(1e-6)), tolerance=0.0).meta["report"]["closed"] == {}
    for wrong in (-1.0, 0.5, True, "1e-4", float("nan")):
        with pytest.raises(ModelError, match="The tolerance of compile is"):
            compile(model, tolerance=wrong)


def test_the_model_is_as_drawn_afterwards():
    model = drawn.sarrus(drawn.shifted(1e-5))
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


def test_a_link_of_two_welded_bodies_is_one():
    def half_links(pen):
        m = Model("Bennett of halves", dimension=3)
        points, axes = drawn.bennett_joints()
        bodies = [m.ground]
        for k in range(3):
            halves = [
                m.body(f"half {k}{n}", mass=1.0, com=s * points[k] + (1 - s) * points[k + 1], inertia=(0.1, 0.1, 0.1))
                for n, s in enumerate((0.75, 0.25))
            ]
            m.weld(f"weld {k}", *halves)
            bodies.append(halves)
        for k in range(4):
            first = bodies[k] if k == 0 else bodies[k][1]
            second = bodies[k + 1][0] if k < 3 else m.ground
            m.revolute("ABCD"[k], first, second, point=pen(points[k]), axis=pen(axes[k]))
        return m

    system = compile(half_links(drawn.shifted(1e-6)))
    assert system.meta["report"]["degrees_of_freedom"] == 1
    assert set(system.meta["report"]["closed"]) == set("ABCD")
    simulate(system, END, STEP)
    assert overconstrained.corrected_joints(half_links(drawn.exact)) == []


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
    for apart in (0.0, 1e-16, 1e-13, 1e-10, 1e-7, 1e-5, 1e-4):
        m = Model("gate", gravity=(0.0, -9.81, 0.0))
        gate = m.body("gate", mass=1.0, com=(0.5, 0.0, 0.5), inertia=(0.1, 0.1, 0.1))
        m.revolute("low", m.ground, gate, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
        m.revolute("high", m.ground, gate, point=(0.0, 0.0, 1.0), axis=(apart, 0.0, 1.0))
        m.sense_position("y", gate, (0.5, 0.0, 0.5), "y")
        system = compile(m)
        assert system.meta["report"]["degrees_of_freedom"] == 1, apart
        ends.append(simulate(system, 0.5, 0.001, progress=False)["y"][-1])
    assert ends == pytest.approx([ends[0]] * len(ends), rel=1e-8)


def scissor_height(stages):
    """Rise of the plate of the scissor lift in END, m: one freedom, the angle of the bars."""
    L = np.hypot(1.6, 0.6)

    def inertia(angle):
        bars = sum(2.0 * (0.25 * np.sin(angle) ** 2 + ((k + 0.5) * np.cos(angle)) ** 2) for k in range(stages))
        return L**2 * (bars + 5.0 * (stages * np.cos(angle)) ** 2) + 2.0 * stages * 0.2

    weight = 9.81 * L * (stages**2 + 5.0 * stages)
    return stages * L, inertia, weight, np.arctan2(0.6, 1.6)


def scott_russell_height(blocks):
    """Rise of the upper end of the rod in END, m: one freedom, its angle."""

    def inertia(angle):
        slides = 0.3 if blocks else 0.0  # of both together, whatever the angle
        return 0.02 + 1.0 * 0.25**2 + 2.0 * 0.5**2 + 0.17 + slides

    weight = 9.81 * (1.0 * 0.25 + 2.0 * 0.5 + (0.3 if blocks else 0.0))
    return 1.0, inertia, weight, 0.7


def rise(arm, inertia, weight, start):
    """Of `arm` sin(angle) under J angle'' + J' angle'^2 / 2 = -weight cos(angle)."""

    def rates(t, y):
        change = (inertia(y[0] + 1e-6) - inertia(y[0] - 1e-6)) / 2e-6
        return y[1], -(weight * np.cos(y[0]) + 0.5 * change * y[1] ** 2) / inertia(y[0])

    end = solve_ivp(rates, (0.0, END), (start, 0.0), rtol=1e-10, atol=1e-12).y[0, -1]
    return arm * (np.sin(end) - np.sin(start))


GUIDED = {
    **{
        f"lift of {n}, {guide}": (partial(drawn.scissor_lift, stages=n, guide=guide), scissor_height(n))
        for n, guide in ((1, "line"), (1, "column"), (1, "head"), (2, "line"), (3, "column"), (4, "line"))
    },
    **{
        f"Scott Russell, blocks {blocks}": (partial(drawn.scott_russell, blocks=blocks), scott_russell_height(blocks))
        for blocks in (False, True)
    },
}
GUIDED_FEW = ("lift of 1, line", "lift of 3, column", "Scott Russell, blocks True")


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(GUIDED_FEW, GUIDED, "proof"))
def test_a_redundant_guide_is_corrected_or_refused_and_never_stands_in_silence(name):
    """Joints that coincide but for the error of the drawing are no short link."""
    build, form = GUIDED[name]
    aim = rise(*form)
    moved = refused = 0
    for error in (0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 2e-5, 1e-3, 1e-2):
        turn, scale = (0.0, 1.0) if error in (0.0, 1e-3) else (0.7, 0.05)
        model = build(drawn.shifted(error, seed=5) if error else drawn.exact, turn=turn, scale=scale)
        if error > 2e-5:
            with pytest.raises(ModelError, match="Draw it more exactly|cannot be closed; these joints stay open"):
                compile(model)
            refused += 1
            continue
        system = compile(model)
        report = system.meta["report"]
        assert report["degrees_of_freedom"] == 1, error
        assert bool(report["closed"]) == (error > 0.0)
        run = simulate(system, END, STEP)
        x, y = (run[c][-1] - run[c][0] for c in "xy")
        assert (y * np.cos(turn) - x * np.sin(turn)) / scale == pytest.approx(aim, rel=2e-4, abs=30.0 * error)
        moved += 1
    assert (moved, refused) == (8, 2)


@pytest.mark.parametrize("length", [1e-2, 1e-3, 1e-4])
def test_short_links_keep_their_length(length):
    """The correction is of the size of the drawing's error, not of the link, however short that is."""
    for error in (0.0, 1e-8, 0.005 * length):
        build = partial(drawn.three_short_cranks, drawn.shifted(error) if error else drawn.exact, length)
        joints = overconstrained.corrected_joints(build())
        assert bool(joints) == (error > 0.0)
        assert max((j.correction.distance for j in joints), default=0.0) < 2.0 * error + 1e-15
        assert compile(build()).meta["report"]["degrees_of_freedom"] == 1
