"""Points of a body that touch a road."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import array, positive
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import ROAD, Integer
from mbs.elements.reals import Fraction, NotNegative, Positive
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import check_components, fraction

_STICK_STATES = (*(f"deflection {k} of the stick spring, m" for k in (1, 2)), *(f"rate {k} of it, m/s" for k in (1, 2)))


@dataclass(frozen=True)
class ContactPoints(Element):
    """Points or spheres of a body that rest, slide and bounce on a road.

    Normal force at depth d: K d^2/(2 w) up to the onset w, K (d - w/2) beyond; times ``1 + chi d'`` going in and
    ``1/(1 - chi d')`` coming out (Hunt and Crossley 1975, without their pull), so that a point that meets the road with
    v leaves it with v1, ``(chi v - ln(1 + chi v))/chi^2 = v1^2/2 + chi v1^3/3``. Friction is elastoplastic, a spring
    and damper in series with a slider that slips at mu times the normal force: a body at rest stays there. With hardly
    any loss a body may bounce on a slope for ever, and walk down with it.
    """

    stiffness: Positive
    """K of one point, N/m."""
    stick_stiffness: Positive
    """Of a point that sticks, N/m."""
    stick_damping: Positive
    """Of a point that sticks, N s/m."""
    onset: Positive = 0.005
    """w, m."""
    loss: NotNegative = 0.0
    """chi, s/m."""
    friction_factor: NotNegative = 1.0
    """Ratio of the coefficient of friction on a road to the friction of the road."""
    radius: NotNegative = 0.0
    """Radius of the spheres around the points, as of tubes or edges, m."""
    restitution: Fraction = 0.0
    """Least coefficient of restitution e, at fast impacts: ``chi d'`` saturates at 1/e - 1; 0: it does not."""

    _noun = "contact points"
    _signals = (("origin", 3), ("axes", 9))
    _integers = (ROAD, Integer("points", least=1, numbers=("x, m", "y, m", "z, m"), states=_STICK_STATES))
    _appended = 6
    _outputs = (
        Output("normal_force", "N", "sum of the normal forces of the road on the points"),
        Output("touching", "1", "number of points that touch the road"),
        *(Output(f"force_{c}", "N", "force of the road on the body, earth axes") for c in "xyz"),
        Output("depth", "m", "deepest penetration of a point"),
    )

    @staticmethod
    def for_mass(
        mass: float,
        depth: float = 0.005,
        onset: float = 0.005,
        loss: float | None = None,
        friction_factor: float = 1.0,
        radius: float = 0.0,
        gravity: float = 9.81,
        restitution: float = 0.5,
    ) -> ContactPoints:
        """Points of which one carries a mass at rest at a depth; stick as stiff, critically damped.

        Parameters
        ----------
        mass : float
            That one point carries, kg.
        depth : float
            At rest, m.
        onset : float
            Depth over which the stiffness sets in, m.
        loss : float, optional
            chi, s/m, without a least restitution; by default both follow from `restitution`.
        friction_factor : float
            Multiplies the friction of the road.
        radius : float
            Of the spheres around the points, m.
        gravity : float
            m/s2.
        restitution : float
            Coefficient of restitution at the impact speed sqrt(gravity depth), above 0 and below 1; fast impacts have
            half of it.
        """
        m, d, w = (
            positive(v, f"The {name} of contact points")
            for v, name in ((mass, "mass"), (depth, "depth"), (onset, "onset"))
        )
        g = positive(gravity, "The gravity of contact points")
        stiffness = m * g / (0.5 * d * d / w if d < w else d - 0.5 * w)
        stick = (stiffness, stiffness, 2.0 * math.sqrt(stiffness * m))
        if loss is not None:
            return ContactPoints(*stick, w, loss, friction_factor, radius)
        label = "The restitution of contact points"
        e = fraction(positive(restitution, label), label)
        return ContactPoints(*stick, w, _loss(e) / math.sqrt(g * d), friction_factor, radius, 0.5 * e)

    def record(
        self, name: str, origin: AffineVector, axes: Sequence[AffineVector], points: ArrayLike, road: int
    ) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        origin : AffineVector
            Origin of the body.
        axes : sequence of AffineVector
            Its three axes.
        points : array_like, shape (n, 3)
            From the origin along the axes, m.
        """
        label = self._label(name)
        for vector in (origin, *axes):
            check_components(vector, (3,), f"The origin and each axis of {label}")
        positions = array(points, (None, 3), f"the points of {label}")
        if len(axes) != 3 or not len(positions):
            raise ModelError(f"The {label[4:]} need 3 axes and points of shape (n, 3); got {positions.shape}.")
        box = (*positions.min(axis=0).tolist(), *positions.max(axis=0).tolist())
        signals = (*origin.components, *(s for axis in axes for s in axis.components))
        return self._record(name, signals, (road, len(positions)), appended=[*box, *positions.ravel().tolist()])


def _loss(e: float) -> float:
    """Loss times impact speed of the coefficient of restitution e if the least one is half of it.

    With b = e/(2 - e) and u = chi |d'| the factors are (1 + (1 + b) u)/(1 + b u) and its inverse. Energies of
    compression, the integral of u/factor from 0 to x, and of restitution, from 0 to e x, are equal.
    """
    b = e / (2.0 - e)

    def energy(x: float, a: float, c: float) -> float:
        """Integral of u (1 + a u)/(1 + c u)."""
        return 0.5 * a / c * x * x + (1.0 - a / c) * (x / c - math.log1p(c * x) / (c * c))

    low, high = 0.0, 1.0
    while low < 0.5 * (low + high) < high:
        x = 0.5 * (low + high)
        impact = x / (1.0 - x)
        if energy(impact, b, 1.0 + b) < energy(e * impact, 1.0 + b, b):
            high = x
        else:
            low = x
    return low / (1.0 - low)
