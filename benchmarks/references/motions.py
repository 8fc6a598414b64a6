"""Exact motions: by reduction to one or two variables, or by minimum-norm accelerations at tolerance 1e-12.

No augmented Lagrangian is involved.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import mbs
from benchmarks.baselines.lagrange import Lagrange
from benchmarks.baselines.mechanism import Mechanism
from benchmarks.references.rolling_wheels import RollingBicycle
from mbs.scenes import bicycle, cart_pole, double_four_bar, slider_crank, spatial_slider_crank

Array = NDArray[np.float64]
BICYCLE = ("lean.sine", "steer")
DIGITS = {"rtol": 1e-12, "atol": 1e-13}
STIFF_DIGITS = {"rtol": 1e-8, "atol": 1e-10}


def pendulum(t: Array, length: float = 1.0, gravity: float = 9.81) -> Array:
    """Bob (n, 2), m, of the pendulum that starts at the height of its pivot, at x = -length."""
    angle = _solve(lambda _, x: [x[1], -gravity / length * np.cos(x[0])], [np.pi, 0.0], t)[0]
    # measured from the x axis, so that theta'' = -(g/L) cos(theta)
    return length * np.column_stack([np.cos(angle), np.sin(angle)])


def four_bar(windows: int, t: Array) -> Array:
    """B0 (n, 2), m: the cranks stay parallel, [(N+1)/3 + N] theta'' = [(N+1)/2 + N] g sin(theta)."""
    factor = ((windows + 1) / 2 + windows) / ((windows + 1) / 3 + windows) * double_four_bar.GRAVITY
    theta = _solve(lambda _, x: [x[1], factor * np.sin(x[0])], [0.0, double_four_bar.START_SPEED], t)[0]
    return np.column_stack([np.sin(theta), np.cos(theta)])


def equal_arms(t: Array) -> Array:
    """Crank pin (n, 2), m, of the slider-crank with equal arms on the branch where the slider moves."""
    s = slider_crank

    def kinetic(a: float) -> float:
        """2 T / a'^2: crank and rod about their centres, rod centre (1.5 c, 0.5 s), slider 2 c."""
        c2, s2 = np.cos(a) ** 2, np.sin(a) ** 2
        arms = s.MASS * s.LENGTH**2 * (1.0 / 3.0 + 1.0 / 12.0 + 2.25 * s2 + 0.25 * c2)
        return float(arms + s.SLIDER_MASS * s.LENGTH**2 * 4.0 * s2)

    def potential(a: float) -> float:
        return float(s.MASS * s.GRAVITY * s.LENGTH * np.sin(a))

    angle = single_coordinate(kinetic, potential, s.START_ANGLE, s.START_SPEED, t)
    return s.LENGTH * np.column_stack([np.cos(angle), np.sin(angle)])


def spatial_crank(t: Array) -> Array:
    """Slider x (n, 1), m, of the spatial slider-crank, by its one degree of freedom."""
    angle = single_coordinate(*_spatial_crank_energies(), 0.0, spatial_slider_crank.SPEED, t)
    return np.array([[-_rod(a)[0]] for a in angle])


def light_cart(t: Array, cart_mass: float = cart_pole.CART) -> Array:
    """Bob (n, 2), m: momentum along x is constant; the coordinate is the angle of the pole below the horizontal."""
    m, b, L = cart_mass, cart_pole.BOB, cart_pole.LENGTH

    def kinetic(a: float) -> float:
        return float(b * L**2 * (np.cos(a) ** 2 + m / (m + b) * np.sin(a) ** 2))

    angle = single_coordinate(kinetic, lambda a: -b * cart_pole.GRAVITY * L * np.sin(a), 0.0, 0.0, t)
    # centre of mass at rest: m X + b (X + L cos) = b L
    cart = b * L * (1.0 - np.cos(angle)) / (m + b)
    return np.column_stack([cart + L * np.cos(angle), -L * np.sin(angle)])


def rolling_bicycle(t: Array) -> Array:
    """Position sensors (n, k) of the bicycle, by `RollingBicycle`."""
    model = RollingBicycle()
    motion = model.motion(bicycle.SPEED, bicycle.LEAN_RATE, float(t[-1]))
    return model.mechanism.positions(motion(t), BICYCLE)


def single_coordinate(
    kinetic: Callable[[float], float], potential: Callable[[float], float], start: float, rate: float, t: Array
) -> Array:
    """Coordinate (n,) with ``J(s) s'^2 / 2 + V(s) = const``: s'' = -(J' s'^2 / 2 + V') / J, slopes by differences of
    order six.
    """

    def slope(f: Callable[[float], float], s: float, d: float = 2e-3) -> float:
        return sum(w * (f(s + k * d) - f(s - k * d)) for k, w in ((1, 45.0), (2, -9.0), (3, 1.0))) / (60.0 * d)

    return _solve(
        lambda _, x: [x[1], -(0.5 * slope(kinetic, x[0]) * x[1] ** 2 + slope(potential, x[0])) / kinetic(x[0])],
        [start, rate],
        t,
    )[0]


def minimum_norm(system: mbs.System, sensors: tuple[str, ...], t: Array) -> Array:
    """Sensors (n, k) at times (n,) by minimum-norm accelerations; see `minimum_norm_motion`."""
    return minimum_norm_motion(system, sensors, float(t[-1]))(t)


def minimum_norm_motion(
    system: mbs.System, sensors: tuple[str, ...], end: float, stiff: bool = False
) -> Callable[[Array], Array]:
    """Position sensors (n, k) as a function of times (n,) up to `end`, s, by minimum-norm accelerations and DOP853, or
    if `stiff` Radau at tolerance 1e-8.
    """
    mechanism = Mechanism(system)
    method = Lagrange(mechanism, minimum_norm=True)
    solution = solve_ivp(
        lambda time, x: method.rates(float(time), x),
        (0.0, end),
        mechanism.start,
        method="Radau" if stiff else "DOP853",
        dense_output=True,
        **(STIFF_DIGITS if stiff else DIGITS),
    )
    return lambda t: mechanism.positions(solution.sol(t)[: mechanism.nq].T, sensors)


def _solve(rates: Callable[[float, Array], list[float]], start: list[float], t: Array) -> Array:
    return np.asarray(solve_ivp(rates, (0.0, t[-1]), start, method="DOP853", t_eval=t, **DIGITS).y)


def _rod(angle: complex) -> Array:
    """Vector from slider to crank pin, m, at a crank angle from upright about x; minus its first entry is the slider's
    x.

    Also for complex angles: the imaginary part of f(a + i d) / d is the slope of f.
    """
    s = spatial_slider_crank
    y = s.PIVOT[1] - s.CRANK * np.sin(angle)
    z = s.PIVOT[2] + s.CRANK * np.cos(angle)
    return np.array([-np.sqrt(s.ROD**2 - y**2 - z**2), y, z])


def _spatial_crank_energies() -> tuple[Callable[[float], float], Callable[[float], float]]:
    s, d = spatial_slider_crank, 1e-30

    def frame(angle: complex) -> Array:
        """Axes of the rod as columns: along it, its pin (perpendicular to the slider's vertical pin), and their
        product.
        """
        along = _rod(angle) / s.ROD
        pin = np.array([-along[1], along[0], 0.0]) / np.sqrt(along[0] ** 2 + along[1] ** 2)
        return np.column_stack([along, pin, np.cross(along, pin)])

    def kinetic(a: float) -> float:
        R = frame(a + d * 1j)
        spin = R.real.T @ R.imag / d  # skew: components of the angular velocity in the rod's axes
        w = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
        slope = _rod(a + d * 1j).imag / d
        middle = np.array([-0.5 * slope[0], 0.5 * slope[1], 0.5 * slope[2]])
        rod = s.ROD_AXIAL * w[0] ** 2 + s.ROD_TRANSVERSE * (w[1] ** 2 + w[2] ** 2) + s.MASSES[1] * middle @ middle
        crank = s.CRANK_INERTIA[0] + s.MASSES[0] * (0.5 * s.CRANK) ** 2
        return float(crank + rod + s.MASSES[2] * slope[0] ** 2)

    def potential(a: float) -> float:
        height = s.CRANK * np.cos(a)
        return float(9.81 * (s.MASSES[0] * 0.5 * height + s.MASSES[1] * 0.5 * (s.PIVOT[2] + height)))

    return kinetic, potential
