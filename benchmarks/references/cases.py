"""The scenes of the charts: model, compared sensors, exact motion and steps."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import mbs
from benchmarks.references import motions as references
from mbs.model.model import Model
from mbs.scenes import (
    bicycle,
    bricard,
    cart_pole,
    double_four_bar,
    flyball,
    pendulum,
    slider_crank,
    spatial_chain,
    spatial_slider_crank,
    squeezer,
)

Array = NDArray[np.float64]
SAMPLES = 50  # instants of a run at which errors are measured; steps are end / (SAMPLES k)
STORED = Path(__file__).with_name("stored")
"""Motions that take seconds or minutes to compute; `python -m benchmarks.work_precision motions` writes them."""


@dataclass(frozen=True)
class Case:
    """A scene with its exact motion."""

    title: str
    """Name of the scene and its difficulty."""
    build: Callable[[], Model]
    sensors: tuple[str, ...]
    """Names of the components of the output point."""
    end: float
    """Duration, s."""
    divisions: tuple[int, ...]
    """Numbers of steps in a sample interval: h = end / (SAMPLES division)."""
    exact: Callable[[Array], Array] | None
    """Output point (n, k) at times (n,), s; None: stored, computed by minimum-norm accelerations."""
    conservative: bool = True
    """Without dissipation."""
    energy_stays: bool = True
    """Whether the energy is constant: also without a motor."""
    map_work: float = 2.4e5
    """Largest product of steps and coordinates of a run of the stability maps."""
    classical: bool = True
    """Whether the dense methods in Python are run."""
    unit: str = "m"
    """Unit of the output point."""
    slow: bool = False
    """Whether `exact` takes seconds, so that its motion is stored."""

    @property
    def stored(self) -> bool:
        """Whether the motion is read from a file."""
        return self.exact is None or self.slow


def _xy(name: str) -> tuple[str, ...]:
    return f"{name}.position.x", f"{name}.position.y"


def _four_bar(windows: int, divisions: tuple[int, ...]) -> Case:
    return Case(
        f"{windows}-four-bar: ten singular positions",
        lambda: double_four_bar.build(windows),
        _xy("B0"),
        10.0,
        divisions,
        lambda t: references.four_bar(windows, t),
        map_work=2.4e5 if windows <= 2 else 4.2e5,
        classical=windows <= 2,
    )


CASES: dict[str, Case] = {
    "pendulum": Case(
        "pendulum: never singular",
        pendulum.build,
        _xy("bob"),
        10.0,
        (1, 2, 4, 10, 20, 40, 100, 200),
        references.pendulum,
    ),
    "pendulum_1000s": Case(
        "pendulum over 1000 s: drift",
        pendulum.build,
        _xy("bob"),
        1000.0,
        (200, 400, 1000, 2000, 4000, 10000),
        references.pendulum,
        classical=False,
    ),
    "double_four_bar": _four_bar(2, (1, 2, 4, 8, 20, 40, 100, 200, 400)),
    "four_bar_40": _four_bar(40, (1, 2, 4, 8, 20, 40, 100, 200)),
    "four_bar_200": _four_bar(200, (1, 2, 4, 8, 20, 40, 100)),
    "squeezer": Case(
        "Andrews' squeezer: a time scale of milliseconds",
        squeezer.build,
        _xy("F"),
        0.05,
        (1, 2, 4, 10, 20, 40, 100, 200),
        None,
        energy_stays=False,
    ),
    "bricard": Case(
        "Bricard's loop: redundant everywhere",
        bricard.build,
        tuple(f"P3.position.{c}" for c in "xyz"),
        10.0,
        (1, 2, 4, 8, 20, 40, 100, 200),
        None,
    ),
    "flyball": Case(
        "stiff flyball governor: 27000 1/s in the dampers",
        flyball.build,
        ("slider.position.z",),
        10.0,
        (1, 2, 4, 8, 20, 40, 100, 200),
        None,
        conservative=False,
        energy_stays=False,
        classical=False,
    ),
    "slider_crank": Case(
        "slider-crank with equal arms: branch points",
        slider_crank.build,
        _xy("A"),
        5.0,
        (1, 2, 4, 10, 20, 40, 100, 200),
        references.equal_arms,
    ),
    "spatial_slider_crank": Case(
        "spatial slider-crank",
        spatial_slider_crank.build,
        ("slider.position.x",),
        5.0,
        (1, 2, 4, 10, 20, 40, 100, 200),
        references.spatial_crank,
        slow=True,
    ),
    "cart_pole": Case(
        "cart-pole with a light cart: spikes of 4429 rad/s",
        cart_pole.build,
        _xy("bob"),
        1.0,
        (2, 20, 200, 2000, 20000),
        references.light_cart,
        map_work=6e5,
        classical=False,
    ),
    "bicycle": Case(
        "rigid bicycle: wheels that roll without slip",
        bicycle.build,
        references.BICYCLE,
        5.0,
        (1, 2, 4, 10, 20, 40, 100, 200),
        references.rolling_bicycle,
        unit="rad",
        slow=True,
    ),
    "spatial_chain": Case(
        "chain of ten links: smooth, no loop",
        spatial_chain.build,
        tuple(f"tip.position.{c}" for c in "xyz"),
        10.0,
        (1, 2, 3, 4, 6, 10, 20, 40, 100, 200, 400),
        None,
        map_work=4.2e5,
    ),
}
SHARED = ("double_four_bar", "bricard", "spatial_chain", "four_bar_40", "four_bar_200")
"""Scenes that peers run too."""


SLOW = tuple(name for name, case in CASES.items() if case.stored)
"""Scenes whose motion is read from a file."""


@cache
def system_of(name: str) -> mbs.System:
    """The compiled scene."""
    return mbs.compile(CASES[name].build())


@cache
def exact_of(name: str) -> Array:
    """Exact output point (SAMPLES + 1, k) at equal intervals up to the end."""
    if CASES[name].stored:
        return np.asarray(np.loadtxt(STORED / f"{name}.csv", delimiter=",", ndmin=2)[:, 1:])
    return computed(name)


def computed(name: str) -> Array:
    """Result of `exact_of`, always computed."""
    case = CASES[name]
    motion = case.exact or references.minimum_norm_motion(
        system_of(name), case.sensors, case.end, stiff=not case.conservative
    )
    return motion(np.linspace(0.0, case.end, SAMPLES + 1))


def store(name: str) -> None:
    """Compute and write a stored motion."""
    case = CASES[name]
    rows = np.column_stack([np.linspace(0.0, case.end, SAMPLES + 1), computed(name)])
    command = f"python -m benchmarks.work_precision motions --only {name}"
    header = f"{command}\n" + ",".join(["time_s", *case.sensors])
    np.savetxt(STORED / f"{name}.csv", rows, fmt="%.17g", delimiter=",", header=header)


def size_of(name: str) -> float:
    """Extent of the motion of the output point, in its unit: the scale of its errors."""
    return float(np.linalg.norm(np.ptp(exact_of(name), axis=0)))
