"""Counters and residuals of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

from mbs.kernel.header.steps import Balance

MIN_CORRELATION = 0.5
"""Least squared correlation of energy and time of a growth: one period of an oscillation has 0.6, two have 0.15."""
MIN_ROTATION = 12.0  # rad of the motion from which growth and oscillation are distinguished


@dataclass(frozen=True)
class Report:
    """Counters and residuals of the solver since the last initialisation.

    Parameters
    ----------
    steps, iterations, factorizations, solves, halvings, failures : int
        Counts; a halving is a step split in two because it did not converge.
    last_iterations, max_iterations : int
        Newton iterations of the last attempt of a step, and the most any attempt took.
    negative_pivots : int
        Of the last factorization: above 0 the tangent was not positive definite; after a static equilibrium: above 0 it
        is unstable.
    residual : float
        ``max |r_i| / m_i`` of the last step, coordinate units (m).
    violation : float
        ``max |Phi|`` of the last step, m.
    velocity_violation : float
        ``max |Phi_q qd + Phi_t|`` of the last step after projection, m/s.
    energy_jump : float
        Change of the kinetic energy by the last switching of rows, J.
    energy_error : float
        Work that constraint forces and projections did in all steps, J; 0 in the exact motion. Measured by the ALi3-P
        methods, and by Runge-Kutta without flexible bodies.
    energy : float
        Kinetic and potential energy of the state, J; of methods that measure `energy_error`, as the next two.
    work : float
        Work of inputs, drives, dampers and tyres, the sum of their shares of the steps, J.
    kinetic_peak : float
        Largest kinetic energy, J; at least the energy at 1e-6 m/s, so that round-off at rest does not count.
    speed_peak, velocity_path, predictor_path : float
        In the metric of the diagonal of M, sqrt(kg) m/s: largest velocity, length of the path of the velocity, and the
        sum over steps of its distance from ``v + h a`` at their start; for methods of order above two the larger of the
        distances from start and end.
    velocity_squares, predictor_squares : float
        Sums of the squares of the steps' contributions to the last two, kg m^2/s^2.
    energy_floor : float
        Work of gravity along the tolerance of the residual, J; a smaller `energy_error` is not significant.
    free_states : int
        Number of observed states of a System on which only forces with a potential act, so that its energy is
        constant; 0 for other Systems, and after a change of parameters or switches.
    free_start, free_steps, free_energy, free_steps_squares, free_energy_squares, free_product : float
        Energy of the first of these states, J, means of the step numbers and of the energy, and sums of squares and of
        products of the deviations from these means.
    balance : int
        Whether `energy_balance` exceeds its limit by more than the tolerance of the residual explains: 0 no, 1 yes,
        2 yes, and this alone shows that the run is wrong.
    rim_pressed, rim_time, rim_x, rim_y : float
        Largest depth of a rim in a road beyond the limit of its wheel, m, 0: none; its time, s, and position, m.
    divisions : int
        Steps or parts of steps that were halved because a force of a contact or a stop changed abruptly in them, and
        parts of steps that ended at a jump or peak of an input or at a row of a force by table.
    abrupt_steps : int
        Steps in which such a force, or one of a tyre along the road, changed by more than a tenth of the largest one;
        without roads, the force of a spring beyond its stop; steps that ended at a row of a force by table.
    branch_changes : int
        Changes of the assembly mode of closed loops.
    branch_time : float
        Time of the first one, s.
    branch_kind : int
        Kind of the first one: 1 a loop passed a dead centre, or another position, into another mode; 2 a step jumped.
    capped : int
        Steps that ended at `Settings.step_iterations`, or that were not halved at an abrupt force because of it.
    capped_residual : float
        Largest `residual` or `violation` after one of them, m: about the largest error of its positions.
    """

    steps: int
    iterations: int
    factorizations: int
    solves: int
    halvings: int
    failures: int
    last_iterations: int
    max_iterations: int
    negative_pivots: int
    residual: float
    violation: float
    velocity_violation: float
    energy_jump: float = 0.0
    energy_error: float = 0.0
    energy: float = 0.0
    work: float = 0.0
    kinetic_peak: float = 0.0
    speed_peak: float = 0.0
    velocity_path: float = 0.0
    predictor_path: float = 0.0
    velocity_squares: float = 0.0
    predictor_squares: float = 0.0
    energy_floor: float = 0.0
    free_states: int = 0
    free_start: float = 0.0
    free_steps: float = 0.0
    free_energy: float = 0.0
    free_steps_squares: float = 0.0
    free_energy_squares: float = 0.0
    free_product: float = 0.0
    rim_pressed: float = 0.0
    rim_time: float = 0.0
    rim_x: float = 0.0
    rim_y: float = 0.0
    divisions: int = 0
    branch_changes: int = 0
    branch_time: float = 0.0
    branch_kind: int = 0
    capped: int = 0
    capped_residual: float = 0.0
    abrupt_steps: int = 0
    balance: int = Balance.KEPT

    @classmethod
    def from_kernel(cls, values: Mapping[str, float]) -> Report:
        """Report of a kernel instance."""
        return cls(**{f.name: values[f.name] for f in fields(cls)})  # type: ignore[arg-type]

    @property
    def mean_iterations(self) -> float:
        """Newton iterations per step."""
        return self.iterations / max(self.steps, 1)

    @property
    def energy_size(self) -> float:
        """`kinetic_peak` and `work`, J, at least `energy_floor`."""
        return max(self.kinetic_peak + self.work, self.energy_floor)

    @property
    def energy_balance(self) -> float:
        """``|energy_error|`` over `energy_size`; 0 without motion."""
        return abs(self.energy_error) / self.energy_size if self.energy_size > 0.0 else 0.0

    @property
    def energy_growth(self) -> float:
        """Growth of the energy of a free System during the run, J, by linear regression.

        0 if the line explains less than half of the variance: the energy then oscillates.
        """
        scatter = math.sqrt(self.free_steps_squares) * math.sqrt(self.free_energy_squares)
        if (
            not abs(self.free_product) > math.sqrt(MIN_CORRELATION) * scatter
            or self.velocity_path < MIN_ROTATION * self.speed_peak
        ):
            return 0.0
        return self.free_product / self.free_steps_squares * self.steps

    @property
    def energy_change(self) -> float:
        """Error of the energy of a free System relative to the largest kinetic energy.

        It is the growth of the energy or, without growth, its mean minus the energy at the start.
        """
        change = self.energy_growth or (self.free_energy - self.free_start if self.free_states else 0.0)
        return change / self.kinetic_peak if abs(change) > self.energy_floor else 0.0

    @property
    def capped_text(self) -> str:
        """A sentence about the steps that `Settings.step_iterations` ended or left whole; empty if there are none."""
        if self.capped == 0:
            return ""
        violation_text = f"they left at most {1e3 * self.capped_residual:.2g} mm"
        count_text = (
            f"{self.capped} of {self.steps} steps ended at the limit of their iterations, or stayed whole for it"
        )
        return f"{count_text}; {violation_text}."

    def __str__(self) -> str:
        text = (
            f"{self.steps} steps, {self.mean_iterations:.2f} Newton iterations each "
            f"(at most {self.max_iterations} a try), {self.factorizations} factorizations, {self.halvings} halvings; "
            f"last step: residual {self.residual:.1e} m, violation {self.violation:.1e} m"
        )
        return f"{text}; {self.capped_text.rstrip('.')}" if self.capped else text
