"""Time integration methods by name: number in the kernel, title, order, restrictions and relative cost."""

from dataclasses import dataclass

from mbs.kernel.header.steps import METHOD_ORDERS, MethodNumber


@dataclass(frozen=True)
class Method:
    """A time integration method and the Systems that it accepts."""

    number: MethodNumber
    """Number of the method in the kernel."""
    title: str
    """Title in tables and charts."""
    order: int = 2
    """Order of convergence with fixed steps."""
    project: bool | None = None
    """Value of the setting `project` that the name implies; None: as in the settings."""
    conservative_only: bool = False
    """Whether it accepts only Systems without damping."""
    tree_only: bool = False
    """Whether it accepts only Systems with a spanning tree."""
    positions_only: bool = False
    """Whether it accepts only Systems without constraints on velocities."""
    cost: float = 1.0
    """Cost of one unit of work of a controlled run (`ControlledRun.work`), in evaluations of a Runge-Kutta method."""

    @property
    def order_of_changing_steps(self) -> int:
        """Order of convergence with steps of changing size."""
        return METHOD_ORDERS[self.number]

    @property
    def kernel_fields(self) -> dict[str, int]:
        """Fields of `ali3_settings` that the name implies, with their values."""
        fields = {"method": int(self.number)}
        return fields if self.project is None else fields | {"project": int(self.project)}


METHOD_TABLE = {
    "ali3p": Method(
        number=MethodNumber.ALI3P,
        title="ALi3-P",
    ),
    "ali3p_no_projection": Method(
        number=MethodNumber.ALI3P,
        title="ALi3 without projections",
        project=False,
    ),
    "ali3p_generalised_alpha": Method(
        number=MethodNumber.GENERALISED_ALPHA,
        title="ALi3-P, generalised-α",
    ),
    "energy_momentum": Method(
        number=MethodNumber.ENERGY_MOMENTUM,
        title="energy-momentum",
    ),
    "energy_momentum_4": Method(
        number=MethodNumber.ENERGY_MOMENTUM_4,
        title="energy-momentum, order 4",
        order=4,
        conservative_only=True,
    ),
    "runge_kutta_8": Method(
        number=MethodNumber.RUNGE_KUTTA_8,
        title="Runge-Kutta, order 8",
        order=8,
    ),
    "semi_recursive": Method(
        number=MethodNumber.SEMI_RECURSIVE,
        title="semi-recursive, order 8",
        order=8,
        tree_only=True,
        cost=0.2,  # measured: relative coordinates save the factorization of the natural ones
    ),
    "semi_recursive_4": Method(
        number=MethodNumber.SEMI_RECURSIVE_4,
        title="semi-recursive, order 4",
        order=4,
        tree_only=True,
        cost=0.2,
    ),
    "radau_5": Method(
        number=MethodNumber.RADAU_5,
        title="Radau IIA, order 5",
        order=5,
        positions_only=True,
        cost=5.5,  # measured: three stages in one tangent are three times as wide
    ),
}
"""The only list of methods in Python; numbers and orders of changing steps are defined by the kernel."""
