"""Masses on a line between springs, stops, frictions and drives: their motion under DOP853, without the engine."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator, PPoly

from benchmarks.references.newton_euler import INSTANTS, NoReferenceError

Array = NDArray[np.float64]
LOOSE = 1e-8
TIGHT = 1e-10
REST = 1e-100  # squares of smaller rates underflow in SciPy's estimate of an error
AGREE = 1e-4  # of the largest range: by which both runs may differ


@dataclass(frozen=True)
class Link:
    """Spring and damper between two masses, or a mass and a wall; stops below and above a length, which lose energy."""

    ends: tuple[int | float, int | float]  # a whole number is a mass, else the place of a wall, m; the left one first
    stiffness: float = 0.0
    damping: float = 0.0
    length: float = 0.0
    low: tuple[float, float] = (0.0, 0.0)  # length, m, stiffness, N/m
    high: tuple[float, float] = (0.0, 0.0)
    loss: float = 0.0  # s/m

    def tension(self, length: float, rate: float) -> float:
        """By the laws of `mbs.elements.SpringDamper`, written again."""
        pull = self._stop(length - self.high[0], rate) * self.high[1]
        push = self._stop(self.low[0] - length, -rate) * self.low[1]
        return self.stiffness * (length - self.length) + self.damping * rate + pull - push

    def _stop(self, depth: float, rate: float) -> float:
        if depth <= 0.0:
            return 0.0
        return depth * (1.0 + self.loss * rate if rate > 0.0 else 1.0 / (1.0 - self.loss * rate))


@dataclass(frozen=True)
class Friction:
    """Coulomb friction of a mass on another or on the ground (None), which gives elastically while it holds."""

    mass: int
    on: int | None
    largest: float
    stiffness: float
    damping: float


@dataclass(frozen=True)
class Cam:
    """A driven mass: by a curve over time, or a table of lifts over an angle that grows evenly."""

    curve: PPoly
    table: Array | None = None  # rows of angle, rad, and lift, m; the curve is then that of the angle

    def motion(self) -> Callable[[float], tuple[float, float]]:
        """Position and speed over time."""
        curve, speed = self.curve, self.curve.derivative()
        if self.table is None:
            return lambda t: (float(curve(t)), float(speed(t)))
        lift = PchipInterpolator(*self.table.T)
        slope = lift.derivative()
        return lambda t: (float(lift(curve(t))), float(slope(curve(t)) * speed(t)))


@dataclass(frozen=True)
class Machine:
    """Masses with their places and speeds at the start; those that are driven have a `Cam`."""

    masses: Sequence[float]
    start: Sequence[float]
    speeds: Sequence[float]
    links: Sequence[Link] = ()
    frictions: Sequence[Friction] = ()
    driven: Mapping[int, Cam] = field(default_factory=dict)
    pull: float = 0.0  # m/s2 along the line
    span: float = 2.0


def motion(machine: Machine) -> Array:
    """Places (INSTANTS + 1, n), of a run that another at a hundred times its tolerance confirms.

    Laws are continuous in the state, so that the control of steps sees each kink; steps are limited, so that none jumps
    over a short contact. Raises `NoReferenceError`: both runs differ.
    """
    loose, tight = (_run(machine, tolerance, parts) for tolerance, parts in ((LOOSE, 300), (TIGHT, 500)))
    apart = float(np.abs(loose - tight).max()) / float(np.ptp(tight, axis=0).max())
    if not apart <= AGREE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the range")
    return tight


def _run(machine: Machine, tolerance: float, parts: int) -> Array:
    n, driven = len(machine.masses), {i: cam.motion() for i, cam in machine.driven.items()}
    free = [i for i in range(n) if i not in driven]
    mass = np.array(machine.masses)

    def places(t: float, y: Array) -> tuple[Array, Array]:
        x, v = np.empty(n), np.empty(n)
        x[free], v[free] = y[: len(free)], y[len(free) : 2 * len(free)]
        for i, at in driven.items():
            x[i], v[i] = at(t)
        return x, v

    def rates(t: float, y: Array) -> Array:
        x, v = places(t, y)
        force, slips = machine.pull * mass, []
        for link in machine.links:
            (a, va), (b, vb) = ((x[e], v[e]) if isinstance(e, int) else (e, 0.0) for e in link.ends)
            tension = link.tension(b - a, vb - va)
            for end, pulled in zip(link.ends, (tension, -tension), strict=True):
                if isinstance(end, int):
                    force[end] += pulled
        for f, z in zip(machine.frictions, y[2 * len(free) :], strict=True):
            rate = v[f.mass] - (0.0 if f.on is None else v[f.on])
            friction = min(max(f.stiffness * z + f.damping * rate, -f.largest), f.largest)
            slips.append((friction - f.stiffness * z) / f.damping)
            force[f.mass] -= friction
            if f.on is not None:
                force[f.on] += friction
        values = np.concatenate([v[free], force[free] / mass[free], slips])
        values[np.abs(values) < REST] = 0.0
        return values

    t = np.linspace(0.0, machine.span, INSTANTS + 1)
    start, speeds = np.array(machine.start)[free], np.array(machine.speeds)[free]
    run = solve_ivp(
        rates, (0.0, machine.span), np.concatenate([start, speeds, np.zeros(len(machine.frictions))]), t_eval=t,
        method="DOP853", rtol=tolerance, atol=0.1 * tolerance, max_step=machine.span / parts,
    )  # fmt: skip
    if not run.success:
        raise NoReferenceError(run.message)
    return np.array([places(*row)[0] for row in zip(t, run.y.T, strict=True)])
