"""Every reported quantity of every method has the order that docs/speed_and_accuracy.md says, from the first step."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from mbs import Settings, Simulation, compile, simulate
from mbs.scenes import prototype_car
from mbs.settings.settings import METHODS
from tests.methods.closed_forms import QUANTITIES, arm, chirp, rod

PAGE = Path(__file__).parents[2] / "docs" / "speed_and_accuracy.md"
MECHANISMS = {"chirp": chirp, "arm": arm}
STEPS = {2: (50, 100, 200), 4: (40, 80, 160), 5: (20, 40, 80), 8: (8, 12, 24)}  # of a run, by the order of positions
FASTER = {"chirp": 4, "arm": 1}
SHARE = 0.9  # of the printed order, what a measured one is at least
TREE_ONLY = ("semi_recursive", "semi_recursive_4")  # their trees take no drives


def read_table():
    """Orders by method and quantity."""
    text = PAGE.read_text(encoding="utf-8").split("<!-- begin orders -->")[1].split("<!-- end orders -->")[0]
    rows = [[c.strip() for c in line.strip("|\n ").split("|")] for line in text.strip().splitlines()]
    head = rows[0][1:]
    return {row[0].strip("`"): dict(zip(head, map(float, row[1:]), strict=True)) for row in rows[2:]}


TABLE = read_table()


@cache
def case(name):
    mechanism = MECHANISMS[name]()
    return mechanism, compile(mechanism.model)


@cache
def car():
    return compile(prototype_car.build())


def sensed(run, names):
    return np.column_stack([run[n] for n in names])


def errors(name, method, steps):
    """Largest error over all steps of a run, by quantity, for each number of steps."""
    mechanism, system = case(name)
    results = {}
    for n in steps:
        run = simulate(system, mechanism.end, mechanism.end / n, mechanism.inputs, method=method)
        for quantity, expected in mechanism.exact(run.t).items():
            results.setdefault(quantity, []).append(np.abs(sensed(run, QUANTITIES[quantity]) - expected).max())
    return results


def test_the_page_has_every_method_and_quantity():
    assert set(TABLE) == set(METHODS)
    assert all(set(row) == set(QUANTITIES) for row in TABLE.values())


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", MECHANISMS)
def test_the_order_of_every_quantity_is_that_of_the_page(name, method):
    if name == "arm" and method in TREE_ONLY:
        pytest.skip("no drives in trees")
    steps = [FASTER[name] * n for n in STEPS[int(TABLE[method]["position"])]]
    for quantity, found in errors(name, method, steps).items():
        order = -np.polyfit(np.log(steps), np.log(found), 1)[0]
        assert order >= SHARE * TABLE[method][quantity] - 0.1, (quantity, found)


@pytest.mark.parametrize("method", ["energy_momentum", "energy_momentum_4"])
def test_forces_do_not_depend_on_who_looked_when(method):
    _, system = case("arm")
    every, some = (simulate(system, 0.8, 0.01, method=method, every=k) for k in (1, 8))
    for names in QUANTITIES.values():
        assert (sensed(every, names)[::8] == sensed(some, names)).all()
    first = Simulation(system, settings=Settings(method=method))
    first.step(0.01, 20)
    second = Simulation(system)
    second.restore(first.save())
    assert second.sensors == first.sensors


@pytest.mark.slow
@pytest.mark.parametrize("method", ["ali3p", "energy_momentum"])
def test_newtons_law_closes_on_the_car_at_4_ms(method):
    """M qdd + Phi_q' lam = Q at the reported state, in newtons; with extrapolated values it was open by 660."""
    system = car()
    simulation = Simulation(system, settings=Settings(method=method), inputs={"throttle": 0.5})
    ptr, col = system.arrays["row_ptr"], system.arrays["row_col"]
    for k in range(61):
        simulation.run(simulation.time + 0.004, 0.004, inputs={"steering": lambda t: 0.1 * np.sin(6.0 * t)})
        if k % 10:
            continue
        state = simulation.state
        values = simulation.instance.evaluate(state.q.tolist(), state.qd.tolist(), state.y.tolist())
        n = len(state.q)
        open_by = np.reshape(simulation.instance.mass_matrix(state.q.tolist()), (n, n)) @ state.qdd - values["force"]
        forces = np.array(values["jacobian"]) * np.repeat(state.lam, np.diff(ptr))
        np.add.at(open_by, col, forces)
        assert np.abs(open_by).max() < 0.1


# --- inputs within steps ---
# Without projections accelerations swing about those of the constraints behind a jump.
@pytest.mark.parametrize("method", [method for method in METHODS if method != "ali3p_no_projection"])
def test_inputs_jump_where_a_step_begins(method):
    """A table that jumps at 0.3 s, where three steps of 0.1 end: the order of a chirp is not lost to it."""
    _, system = case("chirp")
    table = ([0.0, 0.3, 0.3, 1.0], [0.0, 0.0, 8.0, 8.0])
    before = rod(lambda t: 0.0).exact(np.linspace(0.0, 0.3, 4))
    run = simulate(system, 0.6, 0.02, {"motor": table}, method=method)
    k = 15
    assert run.t[k] == pytest.approx(0.3)
    expected = [before[q][-1] for q in ("acceleration", "joint force")]
    tolerance = {2.0: 0.2, 4.0: 2e-3, 5.0: 1e-3, 8.0: 1e-7}[TABLE[method]["position"]]
    for names, value in zip((QUANTITIES["acceleration"], QUANTITIES["joint force"]), expected, strict=True):
        assert sensed(run, names)[k] == pytest.approx(value, abs=tolerance)  # the value before the jump
    stepped = rod(lambda t: 8.0 if t > 0.3 else 0.0).exact(np.linspace(0.0, 0.6, 31))
    for quantity, value in stepped.items():
        actual = sensed(run, QUANTITIES[quantity])[-1]
        assert actual == pytest.approx(value[-1], abs=tolerance if method != "runge_kutta_8" else 1e-6), quantity


@pytest.mark.parametrize("method", METHODS)
def test_a_constant_that_a_run_brings_holds_from_its_first_instant(method):
    _, system = case("chirp")
    fresh = Simulation(system, settings=Settings(method=method), inputs={"motor": 5.0})
    later = Simulation(system, settings=Settings(method=method))
    a, b = fresh.run(0.2, 0.01, inputs={"motor": 5.0}), later.run(0.2, 0.01, inputs={"motor": 5.0})
    gap = np.abs(sensed(a, QUANTITIES["position"]) - sensed(b, QUANTITIES["position"])).max()
    assert gap < 1e-8


@pytest.mark.parametrize(("method", "h", "bound"), [("radau_5", 0.1, 1e-4), ("energy_momentum", 0.08, 1.5e-2)])
def test_halves_of_a_step_look_at_inputs_at_their_own_times(method, h, bound):
    """Few iterations make the kernel halve; with the whole step's inputs in each half the error is some 0.1 m."""
    mechanism, system = case("chirp")
    few = Settings(method=method, max_iterations=3, tolerance_r=1e-12)
    run = simulate(system, 0.8, h, mechanism.inputs, few)
    assert run.report.halvings > 5
    expected = mechanism.exact(run.t)["position"]
    assert np.abs(sensed(run, QUANTITIES["position"]) - expected).max() < bound


@pytest.mark.parametrize("method", ["ali3p", "runge_kutta_8"])
def test_what_an_input_function_raises_ends_the_run_as_it_was(method):
    _, system = case("chirp")

    def broken(t):
        if t > 0.1:
            raise ZeroDivisionError("the motor is off")
        return 1.0

    simulation = Simulation(system, settings=Settings(method=method))
    with pytest.raises(ZeroDivisionError, match="the motor is off"):
        simulation.run(0.5, 0.04, inputs={"motor": broken})
    assert simulation.time == pytest.approx(0.08)
    assert simulation.instance.get_input(0) == 1.0
    simulation.step(0.04)  # goes on with the last input
    assert np.isfinite(list(simulation.sensors.values())).all()
    with pytest.raises(ValueError, match=r"Input 'motor' is nan N.m at t = .* it must be finite"):
        simulation.run(0.5, 0.04, inputs={"motor": lambda t: float("nan") if t > 0.2 else 0.0})
    with pytest.raises(ValueError, match="must be finite"):
        simulation.run(0.5, 0.04, inputs={"motor": ([0.0, 0.4], [0.0, np.inf])})


@pytest.mark.parametrize("method", ["ali3p", "radau_5", "semi_recursive", "energy_momentum_4"])
def test_tables_in_the_kernel_are_those_of_python(method):
    """With a function beside it a table is read in Python."""
    mechanism = rod(lambda t: 0.0)
    mechanism.model.input("other")
    system = compile(mechanism.model)
    times = np.linspace(0.0, 0.7, 8)
    table = (np.sort(np.append(times, [0.25, 0.25])), np.cos(np.arange(10.0)))
    runs = [
        simulate(system, 0.9, 0.02, {"motor": table} | extra, method=method)
        for extra in ({}, {"other": lambda t: 0.0}, {"other": 0.0})
    ]
    for run in runs[1:]:
        for names in QUANTITIES.values():
            if names != ("torque",):
                assert (sensed(run, names) == sensed(runs[0], names)).all()


def test_the_trapezoidal_rule_takes_the_values_at_the_ends_of_a_step():
    mechanism, system = case("chirp")
    run = simulate(system, 0.1, 0.01, mechanism.inputs)
    by_hand = Simulation(system, inputs={"motor": mechanism.inputs["motor"](0.0)})
    for t in 0.01 * np.arange(1, 11):
        by_hand.instance.run(0.01, 1, np.array([mechanism.inputs["motor"](t)]))
    assert all(by_hand.sensors[n] == run[n][-1] for n in ("tip.x", "tip.vx", "force.y"))
