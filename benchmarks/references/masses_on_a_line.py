"""Motion of masses on a line with springs, stops, friction and drives, by DOP853, without the engine."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator, PPoly

from benchmarks.references.newton_euler import INSTANTS, NoReferenceError

Array = NDArray[np.float64]
LOOSE_TOLERANCE = 1e-8
TIGHT_TOLERANCE = 1e-10
MIN_RATE = 1e-100  # squares of smaller rates underflow in SciPy's estimate of an error
MAX_DIFFERENCE = 1e-4  # largest difference of two runs, relative to the largest range of a mass


@dataclass(frozen=True)
class Link:
    """Spring and damper between two masses, or a mass and a wall, with dissipative stops at a lower and an upper
    length.
    """

    ends: tuple[int | float, int | float]  # an integer: a mass; a float: position of a wall, m; the left end first
    stiffness: float = 0.0
    damping: float = 0.0
    length: float = 0.0
    low: tuple[float, float] = (0.0, 0.0)  # length, m, stiffness, N/m
    high: tuple[float, float] = (0.0, 0.0)
    loss: float = 0.0  # s/m

    def tension(self, length: float, rate: float) -> float:
        """Force, N, by an independent implementation of the laws of `mbs.elements.SpringDamper`."""
        pull = self._stop(length - self.high[0], rate) * self.high[1]
        push = self._stop(self.low[0] - length, -rate) * self.low[1]
        return self.stiffness * (length - self.length) + self.damping * rate + pull - push

    def _stop(self, depth: float, rate: float) -> float:
        if depth <= 0.0:
            return 0.0
        return depth * (1.0 + self.loss * rate if rate > 0.0 else 1.0 / (1.0 - self.loss * rate))


@dataclass(frozen=True)
class Friction:
    """Coulomb friction of a mass on another or on the ground (None), elastic while it sticks.

    `largest`: N; `stiffness`: N/m; `damping`: N s/m.
    """

    mass: int
    on: int | None
    largest: float
    stiffness: float
    damping: float


@dataclass(frozen=True)
class Cam:
    """Drive of a mass: position over time, m, or a table of lift over an angle that is a function of time."""

    curve: PPoly
    table: Array | None = None  # rows of angle, rad, and lift, m; `curve` is then the angle over time, rad

    def motion(self) -> Callable[[float], tuple[float, float]]:
        """Position, m, and speed, m/s, as a function of time, s."""
        curve, speed = self.curve, self.curve.derivative()
        if self.table is None:
            return lambda t: (float(curve(t)), float(speed(t)))
        lift = PchipInterpolator(*self.table.T)
        slope = lift.derivative()
        return lambda t: (float(lift(curve(t))), float(slope(curve(t)) * speed(t)))


@dataclass(frozen=True)
class Machine:
    """Masses, kg, with initial positions, m, and speeds, m/s; driven masses have a `Cam`."""

    masses: Sequence[float]
    start: Sequence[float]
    speeds: Sequence[float]
    links: Sequence[Link] = ()
    frictions: Sequence[Friction] = ()
    driven: Mapping[int, Cam] = field(default_factory=dict)
    pull: float = 0.0  # m/s2 along the line
    span: float = 2.0


def motion(machine: Machine) -> Array:
    """Positions (INSTANTS + 1, n), m, confirmed by a run with a hundred times the tolerance.

    Forces are continuous in the state, so that the step control detects each kink; steps are limited, so that none
    skips a short contact. Raises `NoReferenceError` if both runs differ.
    """
    loose, tight = (
        _run(machine, tolerance, divisions) for tolerance, divisions in ((LOOSE_TOLERANCE, 300), (TIGHT_TOLERANCE, 500))
    )
    apart = float(np.abs(loose - tight).max()) / float(np.ptp(tight, axis=0).max())
    if not apart <= MAX_DIFFERENCE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the range")
    return tight


def _run(machine: Machine, tolerance: float, divisions: int) -> Array:
    n, driven = len(machine.masses), {i: cam.motion() for i, cam in machine.driven.items()}
    free = [i for i in range(n) if i not in driven]
    mass = np.array(machine.masses)

    def positions(t: float, y: Array) -> tuple[Array, Array]:
        x, v = np.empty(n), np.empty(n)
        x[free], v[free] = y[: len(free)], y[len(free) : 2 * len(free)]
        for i, cam_motion in driven.items():
            x[i], v[i] = cam_motion(t)
        return x, v

    def rates(t: float, y: Array) -> Array:
        x, v = positions(t, y)
        force, slips = machine.pull * mass, []
        for link in machine.links:
            (a, va), (b, vb) = ((x[e], v[e]) if isinstance(e, int) else (e, 0.0) for e in link.ends)
            tension = link.tension(b - a, vb - va)
            for end, end_force in zip(link.ends, (tension, -tension), strict=True):
                if isinstance(end, int):
                    force[end] += end_force
        for f, z in zip(machine.frictions, y[2 * len(free) :], strict=True):
            rate = v[f.mass] - (0.0 if f.on is None else v[f.on])
            friction = min(max(f.stiffness * z + f.damping * rate, -f.largest), f.largest)
            slips.append((friction - f.stiffness * z) / f.damping)
            force[f.mass] -= friction
            if f.on is not None:
                force[f.on] += friction
        values = np.concatenate([v[free], force[free] / mass[free], slips])
        values[np.abs(values) < MIN_RATE] = 0.0
        return values

    t = np.linspace(0.0, machine.span, INSTANTS + 1)
    start, speeds = np.array(machine.start)[free], np.array(machine.speeds)[free]
    run = solve_ivp(
        rates, (0.0, machine.span), np.concatenate([start, speeds, np.zeros(len(machine.frictions))]), t_eval=t,
        method="DOP853", rtol=tolerance, atol=0.1 * tolerance, max_step=machine.span / divisions,
    )  # fmt: skip
    if not run.success:
        raise NoReferenceError(run.message)
    return np.array([positions(*row)[0] for row in zip(t, run.y.T, strict=True)])
