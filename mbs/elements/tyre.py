"""Tyre: TMeasy characteristics on first-order carcass deflections."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import instance_of, not_negative, number, positive, vector
from mbs.elements.record import Check, ElementRecord, Output
from mbs.elements.record_checks import index, size
from mbs.kernel.header import ElementType

Pair = tuple[float, float]
"""Values at the nominal load and at twice of it."""


@dataclass(frozen=True)
class TyreCurve:
    """Steady force over slip in one direction (TMeasy, Vehicle System Dynamics 45(S1), 2007, 101-119).

    Parameters
    ----------
    slope : (float, float)
        Initial slope dF/ds, N, at nominal load and twice of it; so all that follows.
    max_force, slide_force : (float, float)
        Largest force and force of full sliding, N, on a road of the friction at which the curves hold
        (`Tyre.curve_friction`); on another road they are scaled to its friction.
    max_slip, slide_slip : (float, float)
        Slips where they are reached.
    """

    slope: Pair
    max_force: Pair
    max_slip: Pair
    slide_force: Pair
    slide_slip: Pair


@dataclass(frozen=True)
class Tyre:
    """Tyre of a wheel that meets the road as a disc.

    Parameters
    ----------
    radius, bottoming_radius : float
        Free radius, and loaded radius below which the rim bears, m.
    stiffness, damping, bottoming_stiffness : float
        Vertical, N/m and N s/m; the damping sets in over the first 5 mm.
    longitudinal, lateral : TyreCurve
        Steady forces.
    trail, trail_zero, trail_end : (float, float)
        Dynamic trail over contact length at zero slip, lateral slips where it first vanishes and where it ends.
    carcass_stiffness, carcass_damping : (float, float)
        Longitudinal and lateral, N/m and N s/m.
    nominal_load : float
        N.
    reference_friction : float, optional
        Friction of the road at which the curves hold. By default the largest longitudinal force over the load at the
        nominal load, so that the friction of a road is the coefficient this tyre reaches there.
    max_load_factor : float
        The curves are clamped at this multiple of the nominal load.
    rolling_resistance : float
        Coefficient of rolling resistance.
    friction_factor : float
        Multiplies the friction of the road.
    """

    radius: float
    bottoming_radius: float
    stiffness: float
    damping: float
    longitudinal: TyreCurve
    lateral: TyreCurve
    trail: Pair
    trail_zero: Pair
    trail_end: Pair
    carcass_stiffness: Pair
    carcass_damping: Pair
    nominal_load: float
    bottoming_stiffness: float = 0.0
    reference_friction: float | None = None
    max_load_factor: float = 3.5
    rolling_resistance: float = 0.0
    friction_factor: float = 1.0

    @property
    def curve_friction(self) -> float:
        """Friction of the road at which the curves hold."""
        if self.reference_friction is not None:
            return self.reference_friction
        return self.longitudinal.max_force[0] / self.nominal_load

    def record(self, name: str, centre: AffineVector, axis: AffineVector, spin: Affine, road: int) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        centre : AffineVector
            Centre of the wheel, m.
        axis : AffineVector
            Unit spin axis, pointing left.
        spin : Affine
            Absolute spin, rad.
        road : int
            Number of the road, from `Model.road`.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range, or a curve is not in order at some load up to the largest.
        """
        what = f"the tyre '{name}'"
        size(centre, (3,), f"The centre of {what}")
        size(axis, (3,), f"The axis of {what}")
        positive(self.radius, f"The radius of {what}")
        positive(self.bottoming_radius, f"The bottoming radius of {what}")
        self._check_kinds(what)
        if not self.bottoming_radius < self.radius:
            raise ValueError(
                f"The bottoming radius {self.bottoming_radius:g} m of {what} must be less than {self.radius:g} m."
            )
        self._check_curves(what)
        named = self._named()
        return ElementRecord(
            name,
            ElementType.TYRE,
            (*centre.components, *axis.components, spin),
            tuple(number(value, f"The {key.replace('_', ' ')} of {what}") for key, value in named),
            (index(road, f"The road of {what}"),),
            (0.0, 0.0, 0.0, 0.0),
            (
                Output("longitudinal_force", "N", "force of the road along the wheel's heading"),
                Output("lateral_force", "N", "force of the road to the left"),
                Output("vertical_force", "N", "force of the road along its normal"),
                Output("aligning_moment", "N m", "moment about the road's normal"),
                Output("slip", "1", "longitudinal slip, positive when driven, between about -1 and 1"),
                Output("slip_angle", "rad", "direction of travel from the wheel's heading, positive to the left"),
                Output("deflection", "m", "radial deflection"),
                Output("loaded_radius", "m", "distance of the contact patch from the centre"),
                *(
                    Output(
                        f"contact_{c}",
                        "m",
                        f"{c} of the contact point, earth; in the air of the road's nearest point in the wheel plane",
                    )
                    for c in "xyz"
                ),
                Output("inclination", "rad", "of the wheel plane from the road's normal, positive with the top right"),
                *(
                    Output(f"normal_{c}", "1", f"{c} of the road's unit normal at the contact point, earth, upwards")
                    for c in "xyz"
                ),
            ),
            tuple(key for key, _ in named),
            tuple(_check_of(key) for key, _ in named),
        )

    def _named(self) -> list[tuple[str, float]]:
        """Names and values of the reals, in the order of `mbs/kernel/src/elements/tyre.c`."""
        scalars = (
            "radius",
            "bottoming_radius",
            "stiffness",
            "damping",
            "bottoming_stiffness",
            "nominal_load",
        )
        named: list[tuple[str, float]] = [(key, getattr(self, key)) for key in scalars]
        named += [("reference_friction", self.curve_friction), ("max_load_factor", self.max_load_factor)]
        for direction, curve in (("longitudinal", self.longitudinal), ("lateral", self.lateral)):
            for key in ("slope", "max_force", "max_slip", "slide_force", "slide_slip"):
                low, high = getattr(curve, key)
                named += [(f"{direction}_{key}_1", low), (f"{direction}_{key}_2", high)]
        for key in ("trail", "trail_zero", "trail_end"):
            low, high = getattr(self, key)
            named += [(f"{key}_1", low), (f"{key}_2", high)]
        for key in ("carcass_stiffness", "carcass_damping"):
            x, y = getattr(self, key)
            named += [(f"{key}_x", x), (f"{key}_y", y)]
        return [*named, ("rolling_resistance", self.rolling_resistance), ("friction_factor", self.friction_factor)]

    def _check_kinds(self, what: str) -> None:
        """Curves are curves, pairs are pairs of numbers."""
        for key in ("longitudinal", "lateral"):
            curve = instance_of(TyreCurve, getattr(self, key), f"The {key} of {what}", "a TyreCurve")
            for part in ("slope", "max_force", "max_slip", "slide_force", "slide_slip"):
                vector(getattr(curve, part), 2, f"the {key} {part.replace('_', ' ')} of {what}")
        for key in ("trail", "trail_zero", "trail_end", "carcass_stiffness", "carcass_damping"):
            vector(getattr(self, key), 2, f"the {key.replace('_', ' ')} of {what}")

    def _check_curves(self, what: str) -> None:
        """Every force and slip stays positive and in order over the whole range of loads."""
        for key in ("stiffness", "nominal_load", "max_load_factor"):
            positive(getattr(self, key), f"The {key.replace('_', ' ')} of {what}")
        if self.reference_friction is not None:
            positive(self.reference_friction, f"The reference friction of {what}")
        for key in ("damping", "bottoming_stiffness", "rolling_resistance", "friction_factor"):
            not_negative(getattr(self, key), f"The {key.replace('_', ' ')} of {what}")
        for value in (*self.carcass_stiffness, *self.carcass_damping):
            positive(value, f"A carcass stiffness or damping of {what}")
        for q in (0.0, self.max_load_factor):
            load = f"at {q * self.nominal_load:g} N"
            for direction, curve in (("longitudinal", self.longitudinal), ("lateral", self.lateral)):
                for key in ("slope", "max_force", "slide_force"):
                    y1, y2 = getattr(curve, key)
                    per_load = 2.0 * y1 - 0.5 * y2 - (y1 - 0.5 * y2) * q
                    positive(per_load, f"The {direction} {key.replace('_', ' ')} per load of {what} {load}")
                first = positive(_linear(curve.max_slip, q), f"The {direction} max slip of {what} {load}")
                last = _linear(curve.slide_slip, q)
                if last <= first:
                    raise ValueError(
                        f"The {direction} slide slip of {what} is {last:g} {load}; it must exceed {first:g}."
                    )
            zero = positive(_linear(self.trail_zero, q), f"The slip of zero trail of {what} {load}")
            end = _linear(self.trail_end, q)
            if end <= zero:
                raise ValueError(f"The end slip of the trail of {what} is {end:g} {load}; it must exceed {zero:g}.")


def _check_of(key: str) -> Check:
    """What a real must satisfy by itself."""
    if key in ("damping", "bottoming_stiffness", "rolling_resistance", "friction_factor"):
        return not_negative
    return number if key in ("trail_1", "trail_2") else positive


def _linear(pair: Pair, q: float) -> float:
    return pair[0] + (pair[1] - pair[0]) * (q - 1.0)
