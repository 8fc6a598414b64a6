"""Tyre by the Magic Formula on first-order carcass deflections."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, tan
from typing import Annotated

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import number, one_of, positive, vector
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import ROAD, Integer
from mbs.elements.reals import NotNegative, Number, Pair, Positive, Real, Reals
from mbs.elements.record import ElementRecord, Output
from mbs.elements.tyre import TYRE_OUTPUTS, WITH_BORE, check_rim
from mbs.elements.tyre_bore import BORE, TyreBore
from mbs.elements.wheel_signals import WHEEL, wheel_signals
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS

VERSIONS = {"PAC2002": 52, "MF52": 52, "MF61": 61, "MF62": 62}
"""Versions of the Magic Formula in the kernel, by the names of files."""
COMBINATIONS = ("none", "weighting", "ellipse")
"""How longitudinal and lateral slip act together, in the order of the kernel."""
SIGNS = {"iso": (1.0, 1.0, 1.0), "sae": (-1.0, 1.0, -1.0), "adapted_sae": (1.0, 1.0, -1.0)}
"""Signs of slip angle, camber, and lateral force with aligning moment, from ISO axes to the axes of a file."""
FACTORS = ("lmux", "lmuy", "lkx", "lky")
"""Fields that multiply the scaling factors of the file."""
Bounds = Annotated[Pair, Real(number, ("least", "most"))]
_MAX_ANGLE = 1.5706
"""Slip angle whose tangent is finite, rad."""


@dataclass(frozen=True)
class MagicTyre(Element):
    """Tyre of a wheel that meets the road as a disc, with the Magic Formula's forces and moments.

    PAC2002 and MF-Tyre 5.2: H. B. Pacejka, Tire and Vehicle Dynamics, 2nd ed., 2006. MF-Tyre 6.1 and 6.2: 3rd ed.,
    2012, section 4.3.2; I. J. M. Besselink et al., Vehicle System Dynamics 48(S1), 2010, 337-352. Without turn slip.
    """

    version: str
    """Key of `VERSIONS`."""
    coefficients: Mapping[str, float]
    """By the names of .tir files; those not named are `MAGIC_COEFFICIENTS`."""
    radius: Positive
    """Free radius, m."""
    bottoming_radius: Positive
    """Loaded radius below which the rim bears, m."""
    stiffness: Positive
    """Vertical, N/m."""
    nominal_load: Positive
    """N."""
    progression: Number = 0.0
    """Vertical force of the squared deflection, N/m^2."""
    damping: NotNegative = 0.0
    """Vertical, N s/m; it grows from zero along the first 5 mm."""
    bottoming_stiffness: NotNegative = 0.0
    """Of the rim, N/m."""
    reference_friction: Positive = 1.0
    """Coefficient of friction of the road on which the coefficients hold."""
    friction_factor: NotNegative = 1.0
    """Multiplies the friction of the road."""
    lmux: Annotated[float, Real(positive, noun="factor on LMUX")] = 1.0
    """Factor on LMUX of the file, the largest longitudinal force."""
    lmuy: Annotated[float, Real(positive, noun="factor on LMUY")] = 1.0
    """Factor on LMUY of the file, the largest lateral force."""
    lkx: Annotated[float, Real(positive, noun="factor on LKX")] = 1.0
    """Factor on LKX of the file, the longitudinal slip stiffness."""
    lky: Annotated[float, Real(positive, noun="factor on LKY")] = 1.0
    """Factor on LKY of the file, the cornering stiffness."""
    pressure: Number = 0.0
    """Deviation of the inflation pressure from the nominal pressure, a ratio to the latter."""
    settling: Positive = 0.006
    """Damping over stiffness of the carcass at rest, s."""
    combination: str = "weighting"
    """One of `COMBINATIONS`."""
    signs: Annotated[str, Real(number, ("slip", "camber", "force"), name="sign")] = "iso"
    """Axes of the coefficients: key of `SIGNS`; x forward; ISO: y left, z up; SAE: y right, z down; the adapted SAE
    axes of Pacejka have a slip angle of the other sign."""
    mirrored: bool = False
    """Whether the tyre is mounted on the other side than it was measured."""
    slip_range: Bounds = (-1.5, 1.5)
    """Longitudinal slip, a ratio, beyond which forces stay."""
    angle_range: Bounds = (-pi / 2.0, pi / 2.0)
    """Likewise, slip angle, rad."""
    camber_range: Bounds = (-0.5, 0.5)
    """Likewise, camber, rad."""
    largest_load: Positive = 1e5
    """Likewise, N; the vertical force itself goes on."""
    bore: Annotated[TyreBore | None, BORE] = None
    """Torque against turning on the spot; it fades out up to 1 m/s, above which the formula gives the moments."""

    _noun = "a tyre"
    _signals = WHEEL
    _integers = (ROAD, Integer("version"), Integer("combination", most=len(COMBINATIONS) - 1), WITH_BORE)
    _states = (0.0,) * 4
    _outputs = (
        *TYRE_OUTPUTS,
        Output("overturning_moment", "N m", "moment about the wheel's heading in the plane of the road"),
        Output("resistance_moment", "N m", "moment of rolling resistance about the wheel's axis"),
    )
    _appended = len(MAGIC_COEFFICIENTS)
    _first_optional = "bore_width"
    _optional_states = (0.0,) * 2

    @property
    def along(self) -> tuple[float, float]:
        """Slip stiffness along the heading at the nominal load, N, and stiffness of the carcass, N/m: from the file, or
        the slip stiffness divided by the relaxation length (by default half a radius).
        """
        c = {**MAGIC_COEFFICIENTS, **self.coefficients}
        slip_stiffness = c["PKX1"] * c["LKX"] * self.lkx * self.nominal_load
        return slip_stiffness, c["LONGITUDINAL_STIFFNESS"] or slip_stiffness / ((c["PTX1"] or 0.5) * self.radius)

    def record(self, name: str, centre: AffineVector, axis: AffineVector, spin: Affine, road: int) -> ElementRecord:
        """Make the record of the element for the kernel.

        Raises
        ------
        ModelError
            A number or a coefficient is not what it must be.
        """
        label = self._label(name)
        signals = wheel_signals(centre, axis, spin, label)
        version = VERSIONS[one_of(self.version, tuple(VERSIONS), f"The version of {label}")]
        combination = COMBINATIONS.index(one_of(self.combination, COMBINATIONS, f"The combination of {label}"))
        signs = SIGNS[one_of(self.signs, tuple(SIGNS), f"The signs of {label}")]
        angles = vector(self.angle_range, 2, f"the angle range of {label}").tolist()
        values = {
            "signs": [-sign if self.mirrored else sign for sign in signs],
            "angle_range": [tan(min(max(angle, -_MAX_ANGLE), _MAX_ANGLE)) for angle in angles],
        }
        integers = (road, version, combination, None if self.bore is None else 1)
        record = self._record(name, signals, integers, values=values, appended=self._coefficients(label))
        check_rim(self.bottoming_radius, self.radius, label)
        return record

    def _coefficients(self, label: str) -> Reals:
        for key in self.coefficients:
            if key not in MAGIC_COEFFICIENTS:
                raise ModelError(f"The Magic Formula of {label} has no coefficient {key}.")
        reals: Reals = {}
        for key, default in MAGIC_COEFFICIENTS.items():
            check = positive if key in ("LMUX", "LMUY", "LKX", "LKY", "LFZO", "LONGVL") else number
            reals[key] = (check(self.coefficients.get(key, default), f"{key} of {label}"), check)
        return reals
