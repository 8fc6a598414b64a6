"""Refusals name the true reason: a step too long for an explicit method, a start too far away; no closed rows."""

import itertools
import re

import numpy as np
import pytest
from scipy.interpolate import PPoly

from benchmarks.methods.honesty_scenes import printed_model
from benchmarks.references.cases import system_of
from mbs import Model, Pose, Settings, Simulation, SimulationError, compile, simulate
from mbs.kernel.binding import FARTHEST, KernelError, LoadedSystem, Status, open_row
from mbs.kernel.binding.instance import Instance
from mbs.model.body import Body
from mbs.scenes import cart_pole, prototype_car, spatial_chain

DAMPING = 5000.0  # 1/s, of 1 kg


def sliding(stiffness, damping):
    """A mass of 1 kg on a spring and a dashpot, with 1 m/s."""
    m = Model("sliding", dimension=2, gravity=(0.0, 0.0))
    bar = m.body("bar", mass=1.0, com=(1.0, 0.0), inertia=0.1)
    m.prismatic("guide", bar, m.ground, axis=(1.0, 0.0), point=(1.0, 0.0))
    m.initial_velocity(bar, linear=(1.0, 0.0), angular=0.0)
    m.spring_damper(
        "pot", (m.ground, (0.0, 0.0)), (bar, (1.0, 0.0)), stiffness=stiffness, damping=damping, free_length=1.0
    )
    m.sense_position("x", bar, None, "x")
    return compile(m)


@pytest.mark.parametrize("method", ["runge_kutta_8", "semi_recursive", "semi_recursive_4"])
def test_a_step_too_long_for_an_explicit_method_is_reported_with_the_rate(method):
    settings = Settings(method=method, max_halvings=0)
    simulation = Simulation(sliding(1.0, DAMPING), settings=settings)
    with pytest.raises(SimulationError, match="the step is too long for an explicit method") as refused:
        simulation.step(0.1, 50)
    text = str(refused.value)
    assert refused.value.status == Status.TOO_STIFF
    if method == "runge_kutta_8":  # the others go on until nothing is left to tell a rate from
        assert float(re.search(r"Its rate here is (\S+) 1/s", text)[1]) == pytest.approx(DAMPING, rel=0.01)
        assert "'ali3p'" in text
    assert "Worst" not in text
    assert "singular" not in text
    assert "energy balance" not in text
    assert simulation.report.failures == 1


def test_the_rate_of_an_oscillation_is_its_frequency():
    """A pair of eigenvalues +-i omega: growths swing from round to round, their geometric mean does not."""
    simulation = Simulation(sliding(1e8, 0.0), settings=Settings(method="runge_kutta_8", max_halvings=0))
    with pytest.raises(SimulationError, match="Its rate here is") as refused:
        simulation.step(1e-3)
    assert float(re.search(r"Its rate here is (\S+) 1/s", str(refused.value))[1]) == pytest.approx(1e4, rel=0.05)


def test_the_step_that_is_named_works():
    step = 1.0 / DAMPING
    for method in ("runge_kutta_8", "semi_recursive_4"):
        run = simulate(sliding(1.0, DAMPING), 0.02, step, method=method, estimate_error=False)
        assert run["x"][-1] == pytest.approx(1.0 + 1.0 / DAMPING, abs=0.1 / DAMPING)


def test_a_step_refused_in_its_second_half_leaves_the_state_where_it_was():
    """A cart of a gram swings round beneath its bob within milliseconds: often the first half of a part is good and the
    second is refused. Then more halves were tried than one branch of them has."""
    depth, h = 2, 0.05
    instance = Instance(LoadedSystem(compile(cart_pole.build(1e-3)).to_bytes()))
    instance.set_settings(max_halvings=depth)
    instance.initialise(0.0)
    second = 0
    for _ in range(200):
        before, tried = [bytes(part) for part in instance.get_state()], instance.report()["halvings"]
        try:
            instance.step(h)
        except KernelError:
            assert [bytes(part) for part in instance.get_state()] == before
            second += instance.report()["halvings"] - tried > depth
            instance.run(1e-4, 10, None, 1, None)
    assert second > 0


def test_a_start_beyond_the_digits_is_refused_as_that():
    car = compile(prototype_car.build())
    for pose in (Pose(x=1e300), Pose(y=-2.0 * FARTHEST), Pose(z=1e20), Pose(speed=1e300), Pose(yaw=-1e7)):
        with pytest.raises(SimulationError, match="too far away or too fast") as refused:
            Simulation(car, pose=pose)
        assert refused.value.status == Status.TOO_FAR
        assert "wishbone" not in str(refused.value)
        assert repr(pose) in str(refused.value)


def test_of_many_rows_the_one_that_is_open_most_is_reported():
    system = compile(spatial_chain.build())
    simulation = Simulation(system)
    result = set()
    for _ in range(5):
        simulation.step(0.01)
        state, report = simulation.state, simulation.instance.report()
        rows = np.abs(simulation.instance.evaluate(state.q, state.qd)["phi"]) * system.arrays["row_measure"]
        assert (report["worst_row"], report["violation"]) == (np.argmax(rows), np.max(rows))
        result.add(report["worst_row"])
    assert len(result) > 1


def test_a_closed_row_is_not_the_reason():
    for gap in (7e-15, float("nan"), float("inf")):
        assert open_row({"worst_row": 0, "violation": gap}, ["lower wishbone"]) == ""
    assert open_row({"worst_row": 1, "violation": 1.0}, ["lower wishbone"]) == ""
    assert open_row({"worst_row": 0, "violation": 1e-3}, ["lower wishbone"]) == "'lower wishbone', open by 0.001 m"


def test_an_iteration_that_ran_away_is_no_singular_tangent():
    """The crank-slider at steps that do not follow it: iterates 1e15 m away, whose tangent says nothing."""
    settings = Settings(method="energy_momentum_4", max_halvings=0)
    with pytest.raises(SimulationError, match="did not converge") as refused:
        simulate(printed_model(), 2.0, 0.02, {"torque": 4.0}, settings, progress=False)
    assert refused.value.status == Status.NOT_CONVERGED


def four_bar_with_crank() -> tuple[Model, Body]:
    """A crank of 1 m at 1 rad before two bars of 1.2 m whose hinge on the ground is 2 m away."""
    m, crank, far = Model("four-bar", dimension=2), np.array([np.cos(1.0), np.sin(1.0)]), np.array([2.0, 0.0])
    half = 0.5 * (far - crank)
    top = crank + half + np.sqrt(1.44 - half @ half) * np.array([-half[1], half[0]]) / np.linalg.norm(half)
    ends = [np.zeros(2), crank, top, far]
    bars = [
        m.body(f"bar {i}", mass=1.0, com=0.5 * (a + b), inertia=0.1)
        for i, (a, b) in enumerate(itertools.pairwise(ends))
    ]
    joined = [m.ground, *bars, m.ground]
    for i, point in enumerate(ends):
        m.revolute(f"hinge {i}", joined[i], joined[i + 1], point=point)
    m.sense_position("top", bars[1], top, "y")
    return m, bars[0]


def driven_four_bar(rate: float, turn: float = 3.0) -> Model:
    """Its crank is driven from 1 rad on."""
    m, crank = four_bar_with_crank()
    guide = m.guide_time("turn", PPoly(np.array([[rate], [0.0]]), [0.0, turn]), unit="rad")
    m.drive("motor", m.relative_angle("angle", m.ground, crank), guide)
    return m


@pytest.mark.parametrize(
    "how",
    [
        {"h": 0.01},
        {"h": 0.01, "method": "radau_5"},
        {"tolerance": 1e-3, "method": "runge_kutta_8"},
    ],
)
def test_a_drive_that_leads_a_loop_no_further_is_named_with_the_time(how):
    """The bars are in line where (2 - cos a)^2 + sin^2 a = 2.4^2."""
    until = (np.arccos((5.0 - 2.4**2) / 4.0) - 1.0) / 0.5
    with pytest.raises(SimulationError, match="driven by 'motor' the joints .* two ways to close them meet") as refused:
        simulate(compile(driven_four_bar(0.5)), 3.0, progress=False, **how)
    assert float(re.search(r"until about t = ([\d.]+) s", str(refused.value))[1]) == pytest.approx(until, abs=2e-4)
    assert "Worst" not in str(refused.value)
    assert "another method" not in str(refused.value)


@pytest.mark.parametrize("rate", [5.0, -5.0])
def test_a_drive_is_not_to_blame_where_positions_close(rate):
    """With one iteration a long step does not converge; the bars come into line after 0.15 s, backwards never."""
    once = Settings(max_iterations=1, max_halvings=0, method="energy_momentum")
    with pytest.raises(SimulationError, match="did not converge") as refused:
        simulate(compile(driven_four_bar(rate)), 0.12, 0.06, settings=once, progress=False)
    assert "two ways" not in str(refused.value)


@pytest.mark.parametrize(("unit", "shown"), [("1", "is 2 at"), ("N.m", "is 2 N.m at")])
def test_a_pure_number_has_no_unit(unit, shown):
    m = Model("one input", dimension=2)
    bar = m.body("bar", mass=1.0, com=(1.0, 0.0), inertia=0.1)
    m.revolute("hinge", m.ground, bar, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, bar)
    m.torque_on("motor", angle, input=m.input("tau", min=-1.0, max=1.0, unit=unit))
    with pytest.raises(ValueError, match=f"'tau' {shown}"):
        simulate(compile(m), 1.0, 0.01, {"tau": 2.0})


def test_a_step_has_a_largest_cost():
    """The governor in a step of a second needs hundreds of parts: it is refused with its reason, and can go on."""
    simulation = Simulation(system_of("flyball"), settings=Settings(max_halvings=16))
    before = simulation.state
    with pytest.raises(SimulationError, match="took more than 1000 iterations") as refused:
        simulation.step(1.0)
    assert refused.value.status == Status.TOO_MUCH_WORK
    assert "Worst" not in str(refused.value)
    assert 1000 < simulation.report.iterations <= 1000 + 2 * simulation.settings.max_iterations
    assert simulation.state.q.tolist() == before.q.tolist()
    simulation.step(0.01, 10)
