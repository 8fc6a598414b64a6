"""Warning about an equilibrium that is not stable."""


class EquilibriumWarning(UserWarning):
    """A static equilibrium is unstable: the smallest disturbance grows."""
