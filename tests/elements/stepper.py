"""A few coordinates with constant mass and elements: trapezoidal rule, Newton with the elements' tangents."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tests.elements.harness import Array, Element, Result

TOLERANCE = 1e-13  # on the residual over mass, m or rad
CAP = 60  # iterations


@dataclass
class Part:
    """An element, the matrix B of its signals u = B q + b, and its inputs as a function of time."""

    element: Element
    B: Array
    b: Array
    inputs: Callable[[float], Sequence[float]] = lambda t: ()


class Stepper:
    """Mass `M` (n,), constant force `load` (n,), parts; starts with consistent accelerations."""

    def __init__(self, M: Array, load: Array, parts: Sequence[Part], q: Array, qd: Array) -> None:
        self.M, self.load, self.parts = np.asarray(M, float), np.asarray(load, float), list(parts)
        self.q, self.qd = np.array(q, float), np.array(qd, float)
        self.y = [np.array(p.element.element.states, float) for p in self.parts]
        self.t, self.iterations = 0.0, []
        self.qdd = self.force(self.q, self.qd, 0.0)[0] / self.M
        self.results = self._evaluate(self.q, self.qd, 0.0)

    def _evaluate(self, q: Array, qd: Array, h: float, accept: bool = False) -> list[Result]:
        return [
            p.element(p.B @ q + p.b, p.B @ qd, y, h, 0.5 * h, 0.25 * h * h, p.inputs(self.t + h), accept)
            for p, y in zip(self.parts, self.y, strict=True)
        ]

    def force(self, q: Array, qd: Array, h: float) -> tuple[Array, Array]:
        """Total force and tangent of the elements over a step h from the present state."""
        Q, S = self.load.copy(), np.zeros((len(q), len(q)))
        for p, r in zip(self.parts, self._evaluate(q, qd, h), strict=True):
            Q += p.B.T @ r.f
            S += p.B.T @ r.S @ p.B
        return Q, S

    def step(self, h: float) -> None:
        q = self.q + h * self.qd + 0.5 * h * h * self.qdd
        count = 0
        while True:
            count += 1
            if count > CAP:
                raise AssertionError(f"no convergence at t = {self.t + h:g}")
            qd = 2.0 / h * (q - self.q) - self.qd
            qdd = 2.0 / h * (qd - self.qd) - self.qdd
            Q, S = self.force(q, qd, h)
            r = 0.25 * h * h * (self.M * qdd - Q)
            if np.max(np.abs(r / self.M)) < TOLERANCE:
                break
            q = q - np.linalg.solve(np.diag(self.M) + S, r)
        self.iterations.append(count)
        self.results = self._evaluate(q, qd, h, accept=True)
        self.y = [r.y for r in self.results]
        self.q, self.qd, self.qdd, self.t = q, qd, qdd, self.t + h

    def run(self, t_end: float, h: float) -> None:
        for _ in range(round((t_end - self.t) / h)):
            self.step(h)

    @property
    def energy(self) -> float:
        """Kinetic energy, elements' potentials, minus the work of the constant force."""
        return float(0.5 * self.M @ self.qd**2 - self.load @ self.q + sum(r.potential for r in self.results))
