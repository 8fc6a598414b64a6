"""Isotropic linear elastic material."""

from dataclasses import dataclass

from mbs.common.checks import is_finite, shown
from mbs.common.errors import ModelError

# from foam and wood to tungsten and diamond, SI
YIELD_RANGE = (1e4, 2e10)
YOUNG_RANGE = (1e5, 2e12)
DENSITY_RANGE = (1.0, 3e4)


@dataclass(frozen=True)
class Material:
    """Young's modulus `E` (Pa), Poisson ratio `nu` and density `rho` (kg/m3).

    The yield strength (Pa) is only shown: pictures of stresses mark it, no model depends on it.
    """

    E: float
    nu: float
    rho: float
    yield_strength: float | None = None

    def __post_init__(self) -> None:
        if not all(is_finite(value) for value in (self.E, self.nu, self.rho)):
            raise ModelError(
                f"A material has E {shown(self.E)}, nu {shown(self.nu)}, rho {shown(self.rho)}; all must be finite."
            )
        if not YOUNG_RANGE[0] <= self.E <= YOUNG_RANGE[1]:
            raise ModelError(f"Young's modulus {self.E:g} does not look like pascals (steel has 2.1e11 Pa).")
        if not -1.0 < self.nu <= 0.5:
            raise ModelError(f"The Poisson ratio {self.nu:g} is not possible: it lies between -1 and 0.5.")
        if not DENSITY_RANGE[0] <= self.rho <= DENSITY_RANGE[1]:
            raise ModelError(f"The density {self.rho:g} does not look like kg/m3 (steel has 7850 kg/m3).")

        strength = self.yield_strength
        if strength is not None and not (is_finite(strength) and YIELD_RANGE[0] <= strength <= YIELD_RANGE[1]):
            raise ModelError(
                f"The yield strength {shown(strength)} is not a strength in Pa (structural steel: 2.35e8 Pa)."
            )

    @property
    def G(self) -> float:
        """Shear modulus, Pa."""
        return self.E / (2 * (1 + self.nu))
