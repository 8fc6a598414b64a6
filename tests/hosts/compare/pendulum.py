"""The scene `tuned`, a swinging mass on a spring, as SciPy integrates it: an engine that shares nothing with ours."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from hosts.measures.signal import Signal

MASS = 2.0  # kg
GRAVITY = 9.80665  # m/s2
FREE_LENGTH = 0.8  # m
END = 6.0
Array = NDArray[np.float64]


def pull(t: Array) -> Array:
    """Force on the mass, N."""
    return 6.0 * np.sin(1.3 * t + 0.15 * t * t)


def motion(stiffness: float, damping: float) -> Callable[[Array], Array]:
    """Position of shape (2, n) at times of shape (n,)."""

    def rates(t: float, state: Array) -> list[float]:
        x, y, u, v = state
        r = np.hypot(x, y)
        tension = stiffness * (r - FREE_LENGTH) + damping * (x * u + y * v) / r
        return [u, v, (pull(t) - tension * x / r) / MASS, -tension * y / r / MASS - GRAVITY]

    solution = solve_ivp(rates, (0.0, END), [0.0, -1.0, 0.0, 0.0], rtol=1e-9, atol=1e-11, dense_output=True).sol
    return lambda t: solution(np.clip(t, 0.0, END))[:2]


def noise(rng: np.random.Generator, count: int, deviation: float, memory: float) -> Array:
    """Noise whose neighbours correlate by `memory`."""
    white = rng.normal(size=count + 200)
    return deviation * np.sqrt(1.0 - memory**2) * lfilter([1.0], [1.0, -memory], white)[200:]


def measured_pull() -> Signal:
    """The force as it is logged, every 10 ms."""
    t = np.arange(0.0, END + 0.005, 0.01)
    return Signal("pull", "pull", "N", t, pull(t))


def measured(
    position: Callable[[Array], Array], seed: int, memory: float = 0.0, delay: float = 0.0, drift: float = 0.0
) -> dict[str, Signal]:
    """Noisy positions every 20 ms; what happens at t is logged at delay + (1 + drift) t."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, END, 0.02)
    values = position((t - delay) / (1.0 + drift))
    return {
        f"bob.{axis}": Signal(f"bob.{axis}", axis, "m", t, values[k] + noise(rng, len(t), s, memory))
        for k, (axis, s) in enumerate((("x", 0.01), ("y", 0.005)))
    }
