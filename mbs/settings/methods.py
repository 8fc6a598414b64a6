"""The methods of the kernel by name: what Python knows of each."""

from dataclasses import dataclass

from mbs.kernel.header.steps import METHOD_ORDERS, MethodNumber


@dataclass(frozen=True)
class Method:
    """A time integrator, with settings that belong to it."""

    number: MethodNumber
    """In the kernel."""
    title: str
    """In tables and charts."""
    order: int = 2
    """With which errors of fixed steps fall."""
    project: bool | None = None
    """Value of the setting `project` that the name stands for; None: that of the settings."""
    conservative_only: bool = False
    tree_only: bool = False
    positions_only: bool = False
    """`conservative_only`, `tree_only`, `positions_only`: whether it takes only Systems without damping, with a
    spanning tree, without rows of velocities."""
    cost: float = 1.0
    """Of one unit of work of a controlled run (`ControlledRun.work`), in evaluations of Runge and Kutta's rule."""

    @property
    def order_of_changing_steps(self) -> int:
        """With which errors of steps that change fall."""
        return METHOD_ORDERS[self.number]

    @property
    def kernel_fields(self) -> dict[str, int]:
        """What the name sets of `ali3_settings`."""
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
"""The only list of methods in Python; numbers and orders of changing steps are those of the kernel."""
