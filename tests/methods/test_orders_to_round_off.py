"""High orders show down to round-off at the default tolerances: a tolerance in metres lets accelerations of 2 / h^2
times itself through."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.baselines.lagrange import Lagrange
from benchmarks.baselines.mechanism import Mechanism
from benchmarks.references.motions import four_bar
from mbs import Settings, Simulation, compile, simulate
from mbs.scenes import bricard, double_four_bar, flyball, squeezer
from tests.methods.models import sliding_mass

END = {"squeezer": 0.025, "bricard": 2.0}
BUILD = {"squeezer": squeezer, "bricard": bricard}
SENSORS = {
    "squeezer": ("F.position.x", "F.position.y"),
    "bricard": tuple(f"P3.position.{c}" for c in "xyz"),
}


def reduced_governor(end):
    """Angle of the rods, height of the slider and spin of the flyball governor: three variables, its symmetry used."""
    f = flyball
    bar, cube = f.DENSITY * f.LENGTH * f.WIDTH**2, f.DENSITY * f.SLIDER_SIDE**3
    axial, transverse = bar * f.WIDTH**2 / 6.0, bar * (f.LENGTH**2 + f.WIDTH**2) / 12.0
    mass, L, gravity = bar + f.BALL, f.LENGTH, 9.81
    d = (0.5 * bar + f.BALL) * L / mass
    inertia = transverse + bar * (0.5 * L - d) ** 2 + f.BALL * (L - d) ** 2

    def rates(_, x):
        a, z, spin, ad, zd = x
        s, c = np.sin(a), np.cos(a)
        reach = f.OFFSET + d * c
        J = axial + cube * f.SLIDER_SIDE**2 / 6.0 + 2.0 * (mass * reach**2 + inertia * c * c + axial * s * s)
        slope = 4.0 * (-mass * reach * d * s + (axial - inertia) * s * c)
        along = np.array([0.5 * L * c, L - 0.5 * L * s - z])
        length = np.hypot(*along)
        by_a, by_z = along @ [-0.5 * L * s, -0.5 * L * c] / length, -along[1] / length
        tension = f.STIFFNESS * (length - f.FREE_LENGTH) + f.DAMPING * (by_a * ad + by_z * zd)
        turn = 0.5 * slope * spin**2 - 2.0 * tension * by_a + 2.0 * mass * gravity * d * c
        return [
            ad,
            zd,
            -slope * ad * spin / J,
            turn / (2.0 * (mass * d * d + inertia)),
            -2.0 * tension * by_z / cube - gravity,
        ]

    start = [f.START_ANGLE, f.SLIDER_HEIGHT, f.SPIN, 0.0, 0.0]
    return solve_ivp(rates, (0.0, end), start, method="Radau", rtol=1e-12, atol=1e-14).y[:, -1]


def exact(name, system):
    """Sensors at the end by minimum-norm accelerations under DOP853."""
    mechanism = Mechanism(system)
    rates = Lagrange(mechanism, minimum_norm=True).rates
    solution = solve_ivp(
        lambda t, x: rates(float(t), x), (0.0, END[name]), mechanism.start, method="DOP853", rtol=1e-13, atol=1e-15
    )
    return mechanism.positions(solution.y[: mechanism.nq, -1:].T, SENSORS[name])[0]


def error(system, names, end, h, method, expected):
    run = simulate(system, end, h, method=method, every=round(end / h))
    return float(np.linalg.norm([run[n][-1] - e for n, e in zip(names, expected, strict=True)])), run.report


@pytest.mark.slow
def test_the_governor_gets_better_with_every_halving_of_the_step():
    _, height, spin, *_ = reduced_governor(0.5)
    system = compile(flyball.build())
    results = [
        error(system, ("slider.position.z", "shaft.rate"), 0.5, h, "radau_5", (height, spin))[0]
        for h in (0.02, 0.01, 0.005, 0.0025, 0.00125)
    ]
    assert (np.diff(results) < 0.0).all(), results
    assert results[2] < 3e-10
    assert results[4] < 3e-12  # a tolerance in metres alone left 4e-8


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "method", "steps", "least"),
    [
        ("squeezer", "radau_5", (1.25e-4, 1e-4, 5e-5, 2.5e-5), 4.7),
        ("bricard", "energy_momentum_4", (0.025, 0.0125, 0.00625, 0.003125), 3.8),
    ],
)
def test_the_order_of_the_default_tolerances_down_to_small_steps(name, method, steps, least):
    system = compile(BUILD[name].build())
    expected = exact(name, system)
    results = [error(system, SENSORS[name], END[name], h, method, expected)[0] for h in steps]
    assert np.polyfit(np.log(steps), np.log(results), 1)[0] > least, results
    assert results[-1] < results[-2]


def test_order_four_through_singular_positions_to_the_figures_of_the_dense_trial():
    """0.1 / 0.05 s: 3.7e-3 / 2.6e-4 m after ten crossings."""
    system, t = compile(double_four_bar.build()), np.arange(0.0, 10.0001, 0.1)
    expected = four_bar(2, t)
    worst = []
    for h in (0.1, 0.05, 0.025):
        run = simulate(system, 10.0, h, method="energy_momentum_4", every=round(0.1 / h))
        place = np.column_stack([run["B0.position.x"], run["B0.position.y"]])
        worst.append(np.linalg.norm(place - expected, axis=1).max())
        assert np.abs(run["energy.total"] - run["energy.total"][0]).max() < 1e-6
    assert worst[0] < 5e-3
    assert worst[1] < 3.5e-4
    assert worst[2] < 2.5e-5


def test_the_tolerances_stay_upper_bounds():
    """A tighter one asks for more iterations than the method needs, a looser one for no fewer."""
    system = compile(squeezer.build())
    counts = [
        simulate(
            system, 0.01, 1e-4, settings=Settings(method="radau_5", tolerance_r=r, tolerance_phi=phi)
        ).report.iterations
        for r, phi in ((1e-6, 1e-6), (1e-10, 1e-11), (1e-16, 1e-15))
    ]
    assert counts[0] == counts[1] < counts[2]


def test_a_singular_position_is_crossed_with_the_order_of_radau():
    """Where the old tangent stalls short of what the method needs, one more is made."""
    system = compile(double_four_bar.build())
    reference = simulate(system, 1.0, 0.0015625, settings=Settings(method="radau_5", tolerance_r=1e-13))
    results = [
        abs(simulate(system, 1.0, h, method="radau_5")["B0.position.x"][-1] - reference["B0.position.x"][-1])
        for h in (0.0125, 0.00625, 0.003125)
    ]
    assert results[2] < 2e-11
    assert results[0] > 20.0 * results[1] > 400.0 * results[2]


def test_a_step_of_order_four_is_five_midpoint_steps():
    """Of an oscillator: the product of (1 + w z/2) / (1 - w z/2), z = i omega h, over the shares w of Suzuki (1990)."""
    omega, h, outer = 2.0, 0.5, 1.0 / (4.0 - 4.0 ** (1.0 / 3.0))
    tight = Settings(method="energy_momentum_4", tolerance_r=1e-14, tolerance_phi=1e-14)
    simulation = Simulation(sliding_mass(omega**2, 0.0, 0.3, -0.4), settings=tight)
    z = 0.5j * omega * h * np.array([outer, outer, 1.0 - 4.0 * outer, outer, outer])
    value = (0.3 + 0.4j / omega) * np.prod((1.0 + z) / (1.0 - z))  # x - i v / omega goes as exp(i omega t)
    simulation.step(h)
    actual = simulation.sensors
    assert (actual["x"], -actual["v"] / omega) == pytest.approx((value.real, value.imag), abs=1e-11)
