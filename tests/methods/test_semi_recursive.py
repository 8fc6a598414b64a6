"""Relative coordinates against natural ones, closed forms and conservation."""

import numpy as np
import pytest
from scipy.special import ellipk

from mbs import Model, Settings, compile, simulate
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import bricard, flyball, spatial_chain
from mbs.settings.settings import METHODS
from tests.methods.trees import GRAVITY, branching, measured, pendulum, random_tree

SEED = 11
SEMI = ("semi_recursive", "semi_recursive_4")
EVALUATIONS = {"semi_recursive": 12, "semi_recursive_4": 4}
ROUND_OFF = 1e-10  # relative, of accelerations
SAME_RULE = 1e-9  # m, between runs of one rule in two sets of coordinates


def tight(method):
    return Settings(method=method, tolerance_phi=1e-13)


def instance_of(system, method):
    instance = Instance(LoadedSystem(system.to_bytes()))
    instance.set_settings(**METHODS[method], tolerance_phi=1e-13)
    return instance


@pytest.mark.parametrize("model", [measured("chain"), measured("bricard"), branching(False)], ids=lambda m: m.name)
def test_accelerations_at_random_states_are_those_of_the_natural_equations(model):
    system = compile(model)
    names = [s["name"] for s in system.meta["sensors"]]
    of_motion = [n for n, name in enumerate(names) if "energy" not in name]
    accelerations = [n for n, name in enumerate(names) if ".a" in name]
    rng = np.random.default_rng(SEED)
    for _ in range(5):
        instance = instance_of(system, "semi_recursive")
        q = system.arrays["q0"] + 0.005 * rng.standard_normal(system.nq)  # near enough that all of them close
        instance.set_q(q, rng.standard_normal(system.nq))
        instance.initialise()
        instance.run(2e-3, int(rng.integers(100, 300)))
        seen = np.zeros((2, len(names)))
        start = instance.save()
        instance.run(1e-3, 2, out=seen)  # the first row is for sensors only
        instance.restore(start)
        instance.step(1e-3)  # to the state of that row
        state = instance.get_state()
        natural = instance_of(system, "ali3p")
        natural.set_q(state[0], state[1])
        natural.initialise()
        expected = np.array(natural.sensors()[:])
        scale = np.abs(expected[accelerations]).max()
        assert scale > 0.1
        for actual in (seen[0], np.array(instance.sensors()[:])):
            np.testing.assert_allclose(actual[of_motion], expected[of_motion], rtol=0.0, atol=ROUND_OFF * scale)


@pytest.mark.parametrize("method", SEMI)
def test_springs_dampers_inputs_a_slide_and_a_weld_agree_with_the_natural_method(method):
    system, names = compile(branching(True)), ["tail.x", "tail.z", "tip.x", "tip.y", "tip.energy"]
    assert system.report["no_tree"] == ""
    assert list(system.arrays["tree_slides"]).count(1) == 1
    assert len(system.arrays["tree_parent"]) == 4  # the welded bodies are one
    inputs = {"push": lambda t: 1.0 + np.sin(3.0 * t)}
    run = simulate(system, 1.0, 0.002, inputs, tight(method), every=100)
    expected = simulate(system, 1.0, 0.002, inputs, tight("runge_kutta_8"), every=100)
    for name in names:
        np.testing.assert_allclose(run[name], expected[name], atol=SAME_RULE if method == SEMI[0] else 1e-7)
    assert np.ptp(expected["tail.x"]) > 0.1


@pytest.mark.parametrize("seed", [1, 2, 5, 6])
def test_random_trees_and_loops_move_as_in_natural_coordinates(seed):
    system = compile(random_tree(seed))
    assert system.report["no_tree"] == ""
    runs = [simulate(system, 0.2, 0.002, settings=tight(m), every=10) for m in ("runge_kutta_8", "semi_recursive")]
    for name in ("x", "y", "z", "ax", "ay", "az"):
        size = 1.0 + np.abs(runs[0][name]).max()
        np.testing.assert_allclose(runs[1][name], runs[0][name], rtol=0.0, atol=SAME_RULE * size)


@pytest.mark.parametrize(
    ("scene", "method", "order", "steps"),
    [
        ("bricard", SEMI[0], 8, (1 / 20, 1 / 24, 1 / 32, 1 / 40)),
        ("chain", SEMI[1], 4, (1 / 100, 1 / 120, 1 / 160, 1 / 200)),
    ],
)
def test_order_of_convergence(scene, method, order, steps):
    system, factor = compile(measured(scene)), 8.0 if scene == "bricard" else 1.0
    names, t_end = [f"end.{c}" for c in "xyz"], 2.0 if scene == "bricard" else 1.0

    def end(h, method):
        run = simulate(system, t_end, h, settings=tight(method), every=round(t_end / h))
        return np.array([run[n][-1] for n in names])

    reference = end(0.002 * factor, "runge_kutta_8")
    used = [factor * h for h in steps]
    errors = [np.linalg.norm(end(h, method) - reference) for h in used]
    assert np.polyfit(np.log(used), np.log(errors), 1)[0] > order - 1.0
    assert errors[-1] < 1e-5


@pytest.mark.parametrize("build", [bricard.build, spatial_chain.build], ids=["Bricard", "chain"])
def test_energy_stays_and_a_step_costs_as_many_evaluations_as_the_rule_has_stages(build):
    system = compile(build())
    for method, evaluations in EVALUATIONS.items():
        run = simulate(system, 2.0, 0.01, settings=tight(method))
        energy = run["energy.total"]
        assert np.abs(energy - energy[0]).max() < (1e-8 if method == SEMI[0] else 1e-2)
        assert run.report.iterations == evaluations * run.report.steps + 1
        assert run.report.violation < 1e-12
        assert run.report.velocity_violation < 1e-11


def test_a_slide_on_a_turning_arm_starts_with_the_rate_it_was_given():
    """The slide is off the axis of its arm, so that the turn of the arm moves it along without any slip."""
    m = Model("slide on an arm", dimension=3, gravity=(0.0, 0.0, 0.0))
    arm = m.body("arm", mass=1.0, com=(0.3, 0.0, 0.0), inertia=(0.1, 0.1, 0.1))
    block = m.body("block", mass=0.5, com=(0.6, 0.4, 0.0), inertia=(0.01, 0.01, 0.01))
    m.revolute("pin", m.ground, arm, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0))
    m.prismatic("rail", block, arm, axis=(1.0, 0.0, 0.0), point=(0.6, 0.4, 0.0))
    turn, slip = 2.0, 0.3
    m.initial_velocity(arm, angular=(0.0, 0.0, turn), linear=(0.0, 0.3 * turn, 0.0))
    m.initial_velocity(block, angular=(0.0, 0.0, turn), linear=(slip - 0.4 * turn, 0.6 * turn, 0.0))
    m.sense_energy("energy", "kinetic")
    for c in "xy":
        m.sense_position(c, block, None, c)
    system = compile(m)
    ends = []
    for method in ("semi_recursive", "radau_5"):
        run = simulate(system, 0.2, 0.01, method=method)
        ends.append([run["x"][-1], run["y"][-1]])
        assert run["energy"][-1] == pytest.approx(run["energy"][0], rel=1e-9)
    assert ends[0] == pytest.approx(ends[1], abs=1e-8)


def test_a_large_swing_has_the_period_of_the_elliptic_integral():
    length, mass, inertia, angle = 0.6, 2.0, 0.3, 2.2
    period = 4.0 * ellipk(np.sin(0.5 * angle) ** 2) * np.sqrt((inertia + mass * length**2) / (mass * GRAVITY * length))
    run = simulate(
        compile(pendulum(length, mass, inertia, angle)), 2.0 * period, period / 400.0, settings=tight(SEMI[0])
    )
    for c in "xz":
        assert run[f"body.{c}"][-1] == pytest.approx(run[f"body.{c}"][0], abs=1e-10)
    assert run["body.x"][200] == pytest.approx(-run["body.x"][0], abs=1e-10)


def test_joint_forces_are_those_of_the_natural_method():
    system = compile(pendulum(0.6, 2.0, 0.3, 2.2))
    runs = [simulate(system, 1.0, 0.01, settings=tight(m)) for m in ("runge_kutta_8", "semi_recursive")]
    assert np.ptp(runs[0]["pin.z"]) > 10.0
    np.testing.assert_allclose(runs[0]["pin.z"], runs[1]["pin.z"], atol=1e-8)


@pytest.mark.parametrize(
    ("build", "method"), [(bricard.build, SEMI[0]), (lambda: branching(True), SEMI[1])], ids=["Bricard", "branching"]
)
def test_a_saved_state_continues_bit_for_bit_however_often_one_looks(build, method):
    system = compile(build())
    whole, often, first = (instance_of(system, method) for _ in range(3))
    for instance in (whole, often, first):
        instance.initialise()
    whole.run(0.01, 40)
    for _ in range(40):
        often.step(0.01)
    first.run(0.01, 17)
    second = instance_of(system, method)
    second.restore(first.save())
    second.run(0.01, 23)
    expected = whole.get_state()
    for other in (often, second):
        for a, b in zip(expected[:3], other.get_state()[:3], strict=True):
            assert a[:] == b[:]
    third = instance_of(system, method)
    third.restore(second.save())
    second.run(0.01, 3)
    third.run(0.01, 3)
    assert second.save() == third.save()


def test_methods_may_change_on_the_way():
    system = compile(bricard.build())
    instance, natural = instance_of(system, "ali3p"), instance_of(system, "runge_kutta_8")
    for other in (instance, natural):
        other.initialise()
        other.run(0.02, 20)
    for method in ("semi_recursive", "runge_kutta_8", "semi_recursive_4", "semi_recursive"):
        instance.set_settings(**METHODS[method])
        instance.run(0.02, 20)
    natural.run(0.02, 80)
    np.testing.assert_allclose(instance.sensors()[:], natural.sensors()[:], atol=2e-2)


def test_a_step_that_fails_leaves_the_last_state_and_a_run_shows_it():
    system = compile(flyball.build())  # dampers of 27000 1/s
    instance = instance_of(system, "semi_recursive")
    instance.initialise()
    before = instance.save()
    with pytest.raises(KernelError):
        instance.run(0.05, 200)
    assert np.isfinite(instance.get_state()[2][:]).all()
    done = instance.report()["steps"]
    again = instance_of(system, "semi_recursive")
    again.restore(before)
    again.run(0.05, done)
    for a, b in zip(instance.get_state()[:3], again.get_state()[:3], strict=True):
        assert a[:] == b[:]


@pytest.mark.parametrize("hinges", [2, 3])
def test_a_door_on_several_hinges_moves_as_on_one(hinges):
    """All rows of its loops are redundant: what round-off leaves of them is no row."""

    def door(count):
        m = Model("door")
        leaf = m.body("leaf", mass=2.0, com=(0.3, 0.1, -0.2), inertia=(0.1, 0.2, 0.25))
        axis = np.array([0.36, 0.48, 0.8])
        for k in range(count):
            m.revolute(f"hinge {k}", m.ground, leaf, point=0.5 * k * axis, axis=axis)
        m.sense_position("x", leaf, None, "x")
        return simulate(compile(m), 1.0, 0.01, method="semi_recursive", progress=False)["x"]

    one = door(1)
    assert np.ptp(one) > 0.05
    np.testing.assert_allclose(door(hinges), one, rtol=0, atol=1e-9)
