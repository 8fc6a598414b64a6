"""Residuals of all compared signals as a function of parameters, and their Jacobian.

A derivative by a parameter of the FMU needs a run; those by delay, drift, bias and gain of the sensors are exact, since
the simulated signal is bias + gain * simulated((t - delay) / (1 + drift)).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hosts.common.display_units import number_in
from hosts.common.errors import HostError
from hosts.compare.curve import Curve, SensedCurve
from hosts.compare.deviations import rms
from hosts.compare.fit_unknowns import Unknown
from hosts.driving.result import Result
from hosts.measures.signal import Signal

Array = NDArray[np.float64]
_SECANT = (
    1e-3  # of a range: smaller differences follow gear shifts and kinks of stops, not the descent of the residuals
)
_REFUSED_RESIDUAL = 1e3  # if the FMU refuses a step: far above the residual of any fit


class RefusedError(HostError):
    """The FMU refuses parameters at which derivatives are needed."""


@dataclass
class Residuals:
    """Simulated minus measured, divided by the noise, all signals in sequence; a function of unknowns, shape (p,)."""

    outputs: Mapping[str, Signal]
    unknowns: Sequence[Unknown]
    """Those of the FMU first."""
    noise: dict[str, float]
    """By signal, in its unit."""
    simulate: Callable[[Mapping[str, float]], Result | str]
    """Function of the parameters of the FMU; a sentence instead of a result if it refuses them."""
    steps: Array = field(default_factory=lambda: np.zeros(0))
    """Steps of central differences by the parameters of the FMU, shape (`count`,)."""
    _curve_cache: dict[tuple[float, ...], dict[str, Curve] | str] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of parameters of the FMU."""
        return sum(u.kind == "parameter" for u in self.unknowns)

    @property
    def blocks(self) -> list[slice]:
        """Rows of each signal."""
        ends = np.cumsum([0] + [len(s.time) for s in self.outputs.values()])
        return [slice(int(a), int(b)) for a, b in pairwise(ends)]

    def rms_by_signal(self, r: Array) -> dict[str, float]:
        """Root mean square of residuals by signal."""
        return {n: rms(r[b]) for n, b in zip(self.outputs, self.blocks, strict=True)}

    def __call__(self, p: Array) -> Array:
        """Residuals of shape (n,)."""
        curves = self._curves(p)
        if isinstance(curves, str):
            return np.full(sum(len(s.time) for s in self.outputs.values()), _REFUSED_RESIDUAL)
        return np.concatenate([self._of_signal(n, curves[n], p) for n in self.outputs])

    def _of_signal(self, name: str, curve: Curve, p: Array) -> Array:
        delay, drift, bias = (self._sensor_value(kind, name, p) for kind in ("delay", "drift", "bias"))
        sensed = SensedCurve(curve, delay, drift, bias, self._sensor_value("gain", name, p, 1.0))
        return sensed.misfit(self.outputs[name]) / self.noise[name]

    def _simulated_times(self, name: str, p: Array) -> Array:
        delay, drift = self._sensor_value("delay", name, p), self._sensor_value("drift", name, p)
        return (self.outputs[name].time - delay) / (1.0 + drift)

    def _sensor_value(self, kind: str, signal: str, p: Array, default: float = 0.0) -> float:
        for u, value in zip(self.unknowns, p, strict=True):
            if u.kind == kind and u.signal in ("", signal):
                return float(value)
        return default

    def jacobian(self, p: Array) -> Array:
        """Derivatives of shape (n, p); central differences if both sides lie within the bounds."""
        curves = self.accepted_curves(p)
        columns = [self._central_difference(p, k) for k in range(self.count)]
        columns += [self._sensor_derivative(p, k, curves) for k in range(self.count, len(self.unknowns))]
        return np.column_stack(columns)

    def one_sided_jacobian(self, p: Array) -> Array:
        """Derivatives as `jacobian` by half as many runs: one-sided differences to the wider side of each range."""
        curves = self.accepted_curves(p)
        columns = [self._one_sided_difference(p, k) for k in range(self.count)]
        return np.column_stack(
            columns + [self._sensor_derivative(p, k, curves) for k in range(self.count, len(self.unknowns))]
        )

    def accepted_curves(self, p: Array) -> dict[str, Curve]:
        """Simulated signals by name. Raises `RefusedError` if the FMU refuses the parameters."""
        curves = self._curves(p)
        if isinstance(curves, str):
            labels = [
                f"{u.name} = {number_in(x, u.unit, '.6g')}"
                for u, x in zip(self.unknowns[: self.count], p, strict=False)
            ]
            raise RefusedError(f"The FMU refuses {', '.join(labels)}. {curves}")
        return curves

    def _one_sided_difference(self, p: Array, k: int) -> Array:
        u, q = self.unknowns[k], p.copy()
        step = max(float(self.steps[k]), _SECANT * (u.high - u.low))
        q[k] += step if u.high - p[k] >= p[k] - u.low else -step
        if isinstance(self._curves(q), str):
            return self._central_difference(p, k)
        return np.asarray((self(q) - self(p)) / (q[k] - p[k]))

    def _central_difference(self, p: Array, k: int) -> Array:
        u, h = self.unknowns[k], self.steps[k]
        ends = [min(max(p[k] + side * h, u.low), u.high) for side in (1.0, -1.0)]
        values = []
        for end in ends:
            q = p.copy()
            q[k] = end
            values.append(None if isinstance(self._curves(q), str) else self(q))
        points = [(e, v) for e, v in zip(ends, values, strict=True) if v is not None]
        if len(points) < 2:
            points.append((float(p[k]), self(p)))
        if len(points) < 2 or points[0][0] == points[1][0]:
            label = f"{u.name} = {number_in(float(p[k]), u.unit, '.6g')}"
            raise RefusedError(f"The FMU refuses values on both sides of {label}; give another range.")
        return np.asarray((points[0][1] - points[1][1]) / (points[0][0] - points[1][0]))

    def _sensor_derivative(self, p: Array, k: int, curves: Mapping[str, Curve]) -> Array:
        u, derivatives = self.unknowns[k], []
        stretch = 1.0 + self._sensor_value("drift", "", p)
        for name, signal in self.outputs.items():
            if u.signal not in ("", name):
                derivatives.append(np.zeros(len(signal.time)))
                continue
            t, gain = self._simulated_times(name, p), self._sensor_value("gain", name, p, 1.0)
            if u.kind == "bias":
                derivative = np.ones(len(t))
            elif u.kind == "gain":
                derivative = curves[name](t)
            else:
                derivative = -gain * curves[name].slope(t) / stretch * (t if u.kind == "drift" else 1.0)
            derivatives.append(derivative / self.noise[name])
        return np.concatenate(derivatives)

    def _curves(self, p: Array) -> dict[str, Curve] | str:
        key = tuple(float(v) for v in p[: self.count])
        if key not in self._curve_cache:
            names = [u.name for u in self.unknowns]
            result = self.simulate(dict(zip(names, key, strict=False)))
            while len(self._curve_cache) > 2 * self.count + 4:
                del self._curve_cache[next(iter(self._curve_cache))]
            self._curve_cache[key] = result if isinstance(result, str) else {n: Curve(result, n) for n in self.outputs}
        return self._curve_cache[key]
