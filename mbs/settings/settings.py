"""Settings of the time integration: method, tolerances and options of the solver."""

from dataclasses import asdict, dataclass

from mbs.common.checks import LARGEST, flag, is_finite, shown, whole
from mbs.kernel.header.steps import Predictor, Update
from mbs.settings.methods import METHOD_TABLE

UPDATES = tuple(update.name.lower() for update in Update)
PREDICTORS = tuple(predictor.name.lower() for predictor in Predictor)
METHODS = {name: method.kernel_fields for name, method in METHOD_TABLE.items()}
"""Fields of `ali3_settings` that each method sets, by its name."""
LIMITED = ("ali3p", "ali3p_no_projection", "ali3p_generalised_alpha")
"""Methods whose steps may be limited to `Settings.step_iterations`."""


@dataclass(frozen=True)
class Settings:
    """Method and solver settings of a run; the defaults are the kernel's.

    Parameters
    ----------
    alpha : float
        Penalty of the mass-normalised constraint rows, 1/s^2. 0 takes the rule ``1 / (eps_rel * h**2)``.
    eps_rel : float
        Regularisation of the multipliers relative to h^2, used by the rule.
    tolerance_r : float
        Bound on the residual ``max |r_i| / m_i`` of a converged step, coordinate units (m). Of drawings smaller than
        0.1 m and larger than 100 m this and `tolerance_phi` are those of such drawings in parts of their length.
    tolerance_phi : float
        Bound on the constraint violation of a converged step, m, beside the round-off of the constraint itself. At
        singular positions a violation hides a displacement of its square root and an error of the multipliers of
        alpha times it, so it should stay near ``1e-4 * eps_rel``.
    max_iterations : int
        Newton iterations of one step.
    max_halvings : int
        How often a step that does not converge, or in which the energy changes without a force, is halved; 0 never.
        One in which a force of a contact or a stop changes abruptly is halved twice at most; `Report.divisions` counts.
    project : bool
        Project velocities and accelerations, equations (24) and (25) of the paper.
    update : {"linearised", "paper"}
        Multiplier update: with the linearised constraint, or equation (16) of the paper. The latter adds alpha times
        the round-off of Phi to the multipliers: `tolerance_r` must then be well above ``1e-16 / eps_rel``.
    geometric : bool
        Exact geometric term of the quadratic constraints in the tangent (23).
    method : str
        One of `METHODS`; `docs/stability.md` says where each must not be used.

        - "ali3p", the default: method of the paper, trapezoidal rule with projections; takes every System.
        - "ali3p_no_projection": the same without projections, for comparison.
        - "ali3p_generalised_alpha": the same with the dissipative rule of Chung and Hulbert.
        - "energy_momentum": conserves the energy of a conservative model; in any other only the dampers dissipate.
        - "energy_momentum_4": five such steps composed to order four; conservative models without element states.
        - "runge_kutta_8": explicit, order eight; smooth motion without stiff forces, element states or singular
          positions.
        - "semi_recursive": the same rule in relative coordinates along a spanning tree of rigid bodies on revolute and
          prismatic joints, many times as fast.
        - "semi_recursive_4": the same with the classical rule of order four, for coarse errors.
        - "radau_5": implicit, order five, damps motion that is too fast for the step; stiff, dissipative models without
          element states or rolling.
    predictor : {"parabola", "acceleration"}
        Start value of a step of ALi3-P: accelerations and multipliers of past steps go on along a parabola where they
        are smooth, or the present ones stay, as in the paper. The first needs fewer iterations.
    step_iterations : int
        Of ALi3-P and generalised-alpha: most Newton iterations of a step with its parts, so that its work is bounded;
        of each part also `max_iterations`. The iterate that is reached then is accepted as it is, steps are halved at
        abrupt forces only, if there is room below the limit, and `Report.capped` and `Report.capped_residual` are
        their number and the largest residual, m. 0, the default: no such limit.
    rho_infinity : float
        Of generalised-alpha: spectral radius at infinite frequency, 0 to 1.

    Raises
    ------
    ValueError
        A value is not valid; the message names the setting and its valid values.
    """

    alpha: float = 0.0
    eps_rel: float = 1e-7
    tolerance_r: float = 1e-10
    tolerance_phi: float = 1e-11
    max_iterations: int = 30
    max_halvings: int = 8
    project: bool = True
    update: str = "linearised"
    geometric: bool = True
    method: str = "ali3p"
    predictor: str = "parabola"
    step_iterations: int = 0
    rho_infinity: float = 0.8

    def __post_init__(self) -> None:
        for name in ("alpha", "eps_rel", "tolerance_r", "tolerance_phi", "rho_infinity"):
            value = getattr(self, name)
            if not is_finite(value) or not abs(value) < LARGEST:
                size = f" below {LARGEST:g}" if is_finite(value) else ""
                raise ValueError(f"Setting {name!r} is {shown(value)}; it must be a finite number{size}.")
            object.__setattr__(self, name, float(value))
        for name in ("project", "geometric"):
            object.__setattr__(self, name, flag(getattr(self, name), f"Setting {name!r}", ValueError))
        if self.alpha < 0.0:
            raise ValueError(
                f"Setting 'alpha' is {self.alpha}; it must be positive, or 0 for the rule 1/(eps_rel h^2)."
            )
        for name in ("eps_rel", "tolerance_r", "tolerance_phi"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"Setting {name!r} is {getattr(self, name)}; it must be positive.")
        for name, least, most in (("max_iterations", 1, 1000), ("max_halvings", 0, 16), ("step_iterations", 0, 1000)):
            value = getattr(self, name)
            object.__setattr__(self, name, whole(value, f"Setting {name!r}", least, most, ValueError))
        for name, choices in (("update", UPDATES), ("predictor", PREDICTORS), ("method", tuple(METHODS))):
            value = getattr(self, name)
            if not isinstance(value, str) or value not in choices:
                raise ValueError(
                    f"Setting {name!r} is {shown(value)}; it must be one of {', '.join(map(repr, choices))}."
                )
        if self.step_iterations > 0 and self.method not in LIMITED:
            raise ValueError(
                f"Setting 'step_iterations' is {self.step_iterations} with the method {self.method!r}; "
                f"only {', '.join(map(repr, LIMITED))} can accept a step that has not converged."
            )
        if not 0.0 <= self.rho_infinity <= 1.0:
            raise ValueError(f"Setting 'rho_infinity' is {self.rho_infinity}; it must lie between 0 and 1.")

    def kernel_fields(self) -> dict[str, float | int]:
        """Values by the field names of `ali3_settings`.

        Returns
        -------
        dict of str to number
            For the kernel.
        """
        fields: dict[str, float | int] = asdict(self)
        fields["project"] = int(self.project)
        fields["geometric"] = int(self.geometric)
        fields["update"] = UPDATES.index(self.update)
        fields["predictor"] = PREDICTORS.index(self.predictor)
        return fields | METHODS[self.method]
