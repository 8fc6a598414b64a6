"""Warning about an equilibrium that is not stable."""

import warnings


class EquilibriumWarning(UserWarning):
    """A static equilibrium is unstable: the smallest disturbance grows."""


def warn_if_unstable(negative_pivots: float, subject: str, stacklevel: int) -> None:
    """Warn if the report of a static equilibrium counts directions in which it is unstable."""
    if negative_pivots:
        warnings.warn(
            f"{subject} is unstable: the smallest disturbance grows; linearise() gives the modes that do. For a stable "
            "equilibrium draw the model a little beside this one, on the side to which it falls.",
            EquilibriumWarning,
            stacklevel=stacklevel + 1,
        )
