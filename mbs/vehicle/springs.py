"""Springs, dampers and end stops of an axle: their section of a car file, its check, and the elements made of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar, TypeAlias

from pydantic import Field

from mbs.common.affine import Affine, AffineVector
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.elements.spring_damper_table import SpringDamperTable, force_of_table
from mbs.model.body import Body
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import (
    Compression,
    DamperForce,
    DamperSpeed,
    Damping,
    Factor,
    FreeLength,
    HysteresisLoss,
    MetalStiffness,
    SmallLength,
    SpringForce,
    Stiffness,
    StopStiffness,
    Travel,
)
from mbs.vehicle.section import Section
from mbs.vehicle.side import Point

Line: TypeAlias = "tuple[AffineVector, float]"
"""Vector between the ends of a spring or damper, and its length as drawn, m."""


@dataclass(frozen=True)
class _PlausibleRange:
    """Plausible range of a table of a force."""

    span: float
    """Least span of its first column."""
    slopes: tuple[float, float]
    """Least and largest slope from row to row."""
    units: tuple[str, str]
    """Units of the first column and of the slopes."""


class ForceLaw(Section):
    """A force that is given by a coefficient or by a table."""

    coefficient: ClassVar[str]
    """Key of the coefficient."""
    plausible: ClassVar[_PlausibleRange]
    """Plausible range of the table."""

    @property
    def given(self) -> dict[str, Any]:
        """The coefficient or the table, whichever is there, by key path."""
        values = {name: getattr(self, name) for name in (self.coefficient, "table")}
        return {self.key(name): value for name, value in values.items() if value is not None}

    def faults(self) -> Iterator[str]:
        """Yield a sentence if the force is not given by either a coefficient or a plausible table."""
        name, key, (unit, slope_unit) = self.key(self.coefficient), self.key("table"), self.plausible.units
        number, table = (getattr(self, field) for field in (self.coefficient, "table"))
        if table is None:
            if number is None:
                yield f"{name} is missing; give it or {key}, rows of two numbers."
            return
        if number is not None:
            yield f"{name} is {number:g}, and there is {key} too; give one of them."
        if len(table) < 2:
            yield f"{key} has {len(table)} rows; it must have two or more."
        elif table[-1][0] - table[0][0] < self.plausible.span:
            yield (
                f"{key} goes from {table[0][0]:g} to {table[-1][0]:g} {unit}; it must span "
                f"{self.plausible.span:g} {unit} or more."
            )
        elif (0.0, 0.0) not in table:
            yield f"{key} has no row [0, 0]: a spring has no force at its free length, a damper none at rest."
        else:
            for k, (first, second) in enumerate(pairwise(table), 1):
                rows, (low, high) = f"{key}.{k} is {list(second)} after {list(first)}", self.plausible.slopes
                if second[0] <= first[0] or second[1] < first[1]:
                    yield f"{rows}; both columns must rise from row to row."
                    return
                slope = (second[1] - first[1]) / (second[0] - first[0])
                if not low <= slope <= high:
                    yield (
                        f"{rows}, a slope of {slope:.3g} {slope_unit}; it must be between {low:g} and {high:g} "
                        f"{slope_unit}."
                    )
                    return


class Spring(ForceLaw, of=SpringDamper):
    """Spring of one wheel."""

    coefficient: ClassVar[str] = "stiffness"
    plausible: ClassVar[_PlausibleRange] = _PlausibleRange(0.01, (200.0, 2e6), ("m", "N/m"))

    stiffness: Stiffness | None = Field(None, description="Spring rate; or there is a table.")
    table: tuple[tuple[Compression, SpringForce], ...] | None = None
    """Rows of compression and force, both rising, through (0, 0), a monotone cubic between them."""
    free_length: FreeLength = Field(description="Length without force, between the points that the suspension names.")
    factor: Factor = 1.0
    """Factor on the force of the spring."""

    @property
    def law(self) -> float | list[tuple[float, float]]:
        """Stiffness, N/m, or rows of stretch, m, and tension, N."""
        if self.table is None:
            assert self.stiffness is not None
            return self.stiffness
        return [(-x, -force) for x, force in reversed(self.table)]


class Damper(ForceLaw, of=SpringDamper):
    """Damper of one wheel, along the spring if the suspension has no points of its own for it."""

    coefficient: ClassVar[str] = "damping"
    plausible: ClassVar[_PlausibleRange] = _PlausibleRange(0.1, (20.0, 1e5), ("m/s", "N.s/m"))

    damping: Damping | None = Field(None, description="Damping coefficient; or there is a table.")
    table: tuple[tuple[DamperSpeed, DamperForce], ...] | None = None
    """Rows of speed and force, both positive in rebound and rising, through (0, 0), a monotone cubic between them."""
    factor: Factor = 1.0
    """Factor on the force of the damper."""

    @property
    def law(self) -> float | list[tuple[float, float]]:
        """Damping, N s/m, or rows of the rate of the length, m/s, and tension, N."""
        if self.table is None:
            assert self.damping is not None
            return self.damping
        return list(self.table)

    def coefficient_at(self, speed: float) -> float:
        """Force per speed with a factor of 1, N s/m. `speed`: m/s, not 0, positive in rebound."""
        law = self.law
        return law if isinstance(law, float) else force_of_table(law, speed) / speed


class Stops(Section, of=EndStops):
    """Bump and rebound stops, whose stiffness is four times as large after a progression; then metal meets metal.

    Over the compression x a stop has the force k x (1 + (x/L)^2), times 1 + chi x' while it is compressed and
    1/(1 - chi x') while it is let go (K. H. Hunt, F. R. E. Crossley, Journal of Applied Mechanics 42, 1975, 440-445).
    """

    bump_gap: Travel
    """Compression of the spring from the drawing to the bump stop."""
    rebound_gap: Travel
    """Extension of the spring from the drawing to the rebound stop."""
    stiffness: StopStiffness
    """k, where a stop begins."""
    bump_progression: SmallLength
    bump_travel: SmallLength
    rebound_progression: SmallLength
    rebound_travel: SmallLength
    metal_stiffness: MetalStiffness
    metal_onset: SmallLength
    loss: HysteresisLoss
    """chi."""

    def around(self, drawn: float) -> EndStops:
        """Make the stops of a spring. `drawn`: length as drawn, m."""
        return self.element(
            EndStops,
            bump_length=drawn - self.bump_gap,
            bump_stiffness=self.stiffness,
            rebound_length=drawn + self.rebound_gap,
            rebound_stiffness=self.stiffness,
            bump_loss=self.loss,
            rebound_loss=self.loss,
        )


@dataclass(frozen=True)
class AxleSprings:
    """Springs, dampers and stops of the wheels of an axle."""

    spring: Spring
    damper: Damper
    stops: Stops | None

    def build(self, b: CarBuilder, wheel: str, spring: Line, damper: Line | None = None) -> None:
        """Add the spring of a wheel with its stops, and its damper, by default along the same line."""
        if damper is None:
            _add(b, f"spring {wheel}", spring, self.spring, self.damper, self.stops)
        else:
            _add(b, f"spring {wheel}", spring, self.spring, None, self.stops)
            _add(b, f"damper {wheel}", damper, None, self.damper, None)


def line_between(lower: tuple[Body, Point], upper: tuple[Body, Point]) -> Line:
    """Line of a spring or damper between two ends: bodies, and positions as drawn, m."""
    return upper[0].point(upper[1]) - lower[0].point(lower[1]), math.dist(lower[1], upper[1])


def line_of_length(length: Affine, drawn: float) -> Line:
    """Line of a spring or damper by its length, and its length as drawn, m, instead of its ends."""
    return AffineVector((Affine(), Affine(), length)), drawn


def _add(
    b: CarBuilder, name: str, line: Line, spring: Spring | None, damper: Damper | None, stops: Stops | None
) -> None:
    """Add spring, damper and stops along a line, with the numbers of the file as parameters."""
    difference, drawn = line
    stiffness, damping = 0.0 if spring is None else spring.law, 0.0 if damper is None else damper.law
    factors = 1.0 if spring is None else spring.factor, 1.0 if damper is None else damper.factor
    end_stops = None if stops is None else stops.around(drawn)
    length = drawn if spring is None else spring.free_length
    law: SpringDamper | SpringDamperTable
    if isinstance(stiffness, float) and isinstance(damping, float):
        law = SpringDamper(stiffness, damping, length, end_stops, *factors)
    else:
        law = SpringDamperTable(stiffness, damping, length, end_stops, *factors)
    element = b.m.add(law.record(name, difference))
    for part, factor in ((spring, "stiffness_factor"), (damper, "damping_factor")):
        if part is not None:
            b.tie_numbers(part, element)
            b.tie(part, "factor", element, factor)
