"""Residuals of all compared signals as a function of parameters, and their Jacobian.

Parameters of the FMU need a run each; delays, drift, bias and gain of the sensors do not: with them the simulated
signal is bias + gain * simulated((t - delay) / (1 + drift)), whose derivatives are exact.
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
_SECANT = 1e-3  # of a range: over finer steps shifts of gears and the kinks of stops hide where the residuals go down
_REFUSED = 1e3  # residual where the FMU refuses a step: far worse than any fit


class RefusedError(HostError):
    """The FMU refuses parameters where derivatives are wanted."""


@dataclass
class Residuals:
    """Simulated minus measured over the noise, of all signals one after the other."""

    outputs: Mapping[str, Signal]
    unknowns: Sequence[Unknown]
    """Those of the FMU first."""
    noise: dict[str, float]
    """By signal, in its unit."""
    simulate: Callable[[Mapping[str, float]], Result | str]
    """Of the parameters of the FMU; the reason, a sentence, where it refuses them."""
    steps: Array = field(default_factory=lambda: np.zeros(0))
    """Shape (p,): of the differences for parameters of the FMU."""
    _kept: dict[tuple[float, ...], dict[str, Curve] | str] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Parameters of the FMU."""
        return sum(u.kind == "parameter" for u in self.unknowns)

    @property
    def blocks(self) -> list[slice]:
        """Rows of each signal."""
        ends = np.cumsum([0] + [len(s.time) for s in self.outputs.values()])
        return [slice(int(a), int(b)) for a, b in pairwise(ends)]

    def left(self, r: Array) -> dict[str, float]:
        """Root mean square of residuals by signal."""
        return {n: rms(r[b]) for n, b in zip(self.outputs, self.blocks, strict=True)}

    def __call__(self, p: Array) -> Array:
        """Residuals of shape (n,)."""
        curves = self._curves(p)
        if isinstance(curves, str):
            return np.full(sum(len(s.time) for s in self.outputs.values()), _REFUSED)
        return np.concatenate([self._of(n, curves[n], p) for n in self.outputs])

    def _of(self, name: str, curve: Curve, p: Array) -> Array:
        delay, drift, bias = (self._own(kind, name, p) for kind in ("delay", "drift", "bias"))
        sensed = SensedCurve(curve, delay, drift, bias, self._own("gain", name, p, 1.0))
        return sensed.misfit(self.outputs[name]) / self.noise[name]

    def _time(self, name: str, p: Array) -> Array:
        delay, drift = self._own("delay", name, p), self._own("drift", name, p)
        return (self.outputs[name].time - delay) / (1.0 + drift)

    def _own(self, kind: str, signal: str, p: Array, otherwise: float = 0.0) -> float:
        for u, value in zip(self.unknowns, p, strict=True):
            if u.kind == kind and u.signal in ("", signal):
                return float(value)
        return otherwise

    def jacobian(self, p: Array) -> Array:
        """Derivatives of shape (n, p); central differences where both sides lie within the bounds."""
        curves = self.accepted(p)
        columns = [self._difference(p, k) for k in range(self.count)]
        columns += [self._exact(p, k, curves) for k in range(self.count, len(self.unknowns))]
        return np.column_stack(columns)

    def one_sided(self, p: Array) -> Array:
        """`jacobian` by half as many runs: differences to that side of the parameters on which the range is wider."""
        curves = self.accepted(p)
        columns = [self._one_sided(p, k) for k in range(self.count)]
        return np.column_stack(columns + [self._exact(p, k, curves) for k in range(self.count, len(self.unknowns))])

    def accepted(self, p: Array) -> dict[str, Curve]:
        """Simulated signals; `RefusedError` where the FMU refuses the parameters."""
        curves = self._curves(p)
        if isinstance(curves, str):
            at = [
                f"{u.name} = {number_in(x, u.unit, '.6g')}"
                for u, x in zip(self.unknowns[: self.count], p, strict=False)
            ]
            raise RefusedError(f"The FMU refuses {', '.join(at)}. {curves}")
        return curves

    def _one_sided(self, p: Array, k: int) -> Array:
        u, q = self.unknowns[k], p.copy()
        step = max(float(self.steps[k]), _SECANT * (u.high - u.low))
        q[k] += step if u.high - p[k] >= p[k] - u.low else -step
        if isinstance(self._curves(q), str):
            return self._difference(p, k)
        return np.asarray((self(q) - self(p)) / (q[k] - p[k]))

    def _difference(self, p: Array, k: int) -> Array:
        u, h = self.unknowns[k], self.steps[k]
        ends = [min(max(p[k] + side * h, u.low), u.high) for side in (1.0, -1.0)]
        values = []
        for end in ends:
            q = p.copy()
            q[k] = end
            values.append(None if isinstance(self._curves(q), str) else self(q))
        at = [(e, v) for e, v in zip(ends, values, strict=True) if v is not None]
        if len(at) < 2:
            at.append((float(p[k]), self(p)))
        if len(at) < 2 or at[0][0] == at[1][0]:
            where = f"{u.name} = {number_in(float(p[k]), u.unit, '.6g')}"
            raise RefusedError(f"The FMU refuses values on both sides of {where}; give another range.")
        return np.asarray((at[0][1] - at[1][1]) / (at[0][0] - at[1][0]))

    def _exact(self, p: Array, k: int, curves: Mapping[str, Curve]) -> Array:
        u, derivatives = self.unknowns[k], []
        segment = 1.0 + self._own("drift", "", p)
        for name, signal in self.outputs.items():
            if u.signal not in ("", name):
                derivatives.append(np.zeros(len(signal.time)))
                continue
            t, gain = self._time(name, p), self._own("gain", name, p, 1.0)
            if u.kind == "bias":
                derivative = np.ones(len(t))
            elif u.kind == "gain":
                derivative = curves[name](t)
            else:
                derivative = -gain * curves[name].slope(t) / segment * (t if u.kind == "drift" else 1.0)
            derivatives.append(derivative / self.noise[name])
        return np.concatenate(derivatives)

    def _curves(self, p: Array) -> dict[str, Curve] | str:
        key = tuple(float(v) for v in p[: self.count])
        if key not in self._kept:
            names = [u.name for u in self.unknowns]
            result = self.simulate(dict(zip(names, key, strict=False)))
            while len(self._kept) > 2 * self.count + 4:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = result if isinstance(result, str) else {n: Curve(result, n) for n in self.outputs}
        return self._kept[key]
