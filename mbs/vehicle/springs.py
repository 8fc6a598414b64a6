"""Springs, dampers and end stops of an axle: their section of a car file, its check, and the elements made of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, TypeAlias

from pydantic import Field

from mbs.common.affine import Affine, AffineVector
from mbs.elements.record import ElementRecord
from mbs.elements.spring_damper import EndStops, SpringDamper
from mbs.elements.spring_damper_table import SpringDamperTable
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

Rows: TypeAlias = "tuple[tuple[float, float], ...]"


@dataclass(frozen=True)
class _PlausibleRange:
    """Plausible range of a table of a force."""

    span: float
    """Least span of its first column."""
    slopes: tuple[float, float]
    """Least and largest slope from row to row."""
    units: tuple[str, str]
    """Units of the first column and of the slopes."""


SPRING_TABLE = _PlausibleRange(0.01, (200.0, 2e6), ("m", "N/m"))
DAMPER_TABLE = _PlausibleRange(0.1, (20.0, 1e5), ("m/s", "N.s/m"))


def law_faults(
    section: Section, name: str, number: float | None, table: Rows | None, plausible: _PlausibleRange
) -> Iterator[str]:
    """Yield a sentence if a force is not given by either a number or a plausible table.

    Parameters
    ----------
    section : Section
        Spring or damper.
    name : str
        Key of the number.
    number : float or None
        Stiffness or damping coefficient.
    table : rows of (float, float) or None
        Table given instead of the number.
    plausible : _Plausible
        Plausible range of the table.
    """
    if number is None and table is None:
        yield f"{section.key(name)} is missing; give it or {section.key('table')}, rows of two numbers."
    if number is not None and table is not None:
        yield f"{section.key(name)} is {number:g}, and there is {section.key('table')} too; give one of them."
    if table is not None and len(table) < 2:
        yield f"{section.key('table')} has {len(table)} rows; it must have two or more."
        return
    if table is not None and table[-1][0] - table[0][0] < plausible.span:
        yield (
            f"{section.key('table')} goes from {table[0][0]:g} to {table[-1][0]:g} {plausible.units[0]}; it must span "
            f"{plausible.span:g} {plausible.units[0]} or more."
        )
        return
    if table is not None and (0.0, 0.0) not in table:
        yield (
            f"{section.key('table')} has no row [0, 0]: a spring has no force at its free length, a damper none "
            "at rest."
        )
        return
    for k, (first, second) in enumerate(pairwise(table or ())):
        if second[0] <= first[0] or second[1] < first[1]:
            yield (
                f"{section.key('table')}.{k + 1} is {list(second)} after {list(first)}; both columns must rise "
                "from row to row."
            )
            return
        slope, (low, high) = (second[1] - first[1]) / (second[0] - first[0]), plausible.slopes
        if not low <= slope <= high:
            yield (
                f"{section.key('table')}.{k + 1} is {list(second)} after {list(first)}, a slope of {slope:.3g} "
                f"{plausible.units[1]}; it must be between {low:g} and {high:g} {plausible.units[1]}."
            )
            return


class Spring(Section, of=SpringDamper):
    """Spring of one wheel."""

    stiffness: Stiffness | None = Field(None, description="Spring rate; or there is a table.")
    table: tuple[tuple[Compression, SpringForce], ...] | None = None
    """Rows of compression and force, both rising, through (0, 0), a monotone cubic between them."""
    free_length: FreeLength = Field(description="Length without force, between the points that the suspension names.")
    factor: Factor = 1.0
    """Factor on the force of the spring."""

    def faults(self) -> Iterator[str]:
        """Fault of a force that has neither or both of a number and a table."""
        yield from law_faults(self, "stiffness", self.stiffness, self.table, SPRING_TABLE)

    @property
    def given(self) -> dict[str, Any]:
        """Stiffness or damping as a number or a table, by key path."""
        name = "stiffness" if self.table is None else "table"
        return {self.key(name): getattr(self, name)}

    @property
    def law(self) -> float | list[tuple[float, float]]:
        """Stiffness, N/m, or rows of stretch, m, and tension, N."""
        if self.table is None:
            assert self.stiffness is not None
            return self.stiffness
        return [(-x, -force) for x, force in reversed(self.table)]


class Damper(Section, of=SpringDamper):
    """Damper of one wheel, along the spring if the suspension has no points of its own for it."""

    damping: Damping | None = Field(None, description="Damping coefficient; or there is a table.")
    table: tuple[tuple[DamperSpeed, DamperForce], ...] | None = None
    """Rows of speed and force, both positive in rebound and rising, through (0, 0), a monotone cubic between them."""
    factor: Factor = 1.0
    """Factor on the force of the damper."""

    def faults(self) -> Iterator[str]:
        """Fault of a force that has neither or both of a number and a table."""
        yield from law_faults(self, "damping", self.damping, self.table, DAMPER_TABLE)

    @property
    def given(self) -> dict[str, Any]:
        """Stiffness or damping as a number or a table, by key path."""
        name = "damping" if self.table is None else "table"
        return {self.key(name): getattr(self, name)}

    @property
    def law(self) -> float | list[tuple[float, float]]:
        """Damping, N s/m, or rows of the rate of the length, m/s, and tension, N."""
        if self.table is None:
            assert self.damping is not None
            return self.damping
        return list(self.table)


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
    """Spring, damper and stops along one line at each wheel of an axle; None if they are elsewhere."""

    spring: Spring | None
    damper: Damper | None
    stops: Stops | None

    @property
    def beside_damper(self) -> tuple[AxleSprings, AxleSprings]:
        """The spring with its stops alone, and the damper alone."""
        return replace(self, damper=None), AxleSprings(None, self.damper, None)


def spring_and_damper(
    b: CarBuilder, name: str, lower: tuple[Body, Point], upper: tuple[Body, Point], springs: AxleSprings
) -> ElementRecord:
    """Add the spring of a wheel with its damper and stops between two ends, with the numbers of the file as parameters.

    `lower`, `upper`: the ends as drawn, m.
    """
    difference = upper[0].point(upper[1]) - lower[0].point(lower[1])
    return _add_along_line(b, name, difference, math.dist(lower[1], upper[1]), springs)


def spring_beside_damper(
    b: CarBuilder,
    wheel: str,
    spring: tuple[tuple[Body, Point], tuple[Body, Point]],
    damper: tuple[tuple[Body, Point], tuple[Body, Point]],
    springs: AxleSprings,
) -> None:
    """Add the spring of a wheel with its stops, and its damper at other points.

    `spring`, `damper`: lower and upper end as drawn, m.
    """
    for name, ends, alone in zip(("spring", "damper"), (spring, damper), springs.beside_damper, strict=True):
        spring_and_damper(b, f"{name} {wheel}", *ends, alone)


def spring_of_length(
    b: CarBuilder,
    wheel: str,
    spring: tuple[Affine, float],
    damper: tuple[Affine, float] | None,
    springs: AxleSprings,
) -> None:
    """Add the spring of a wheel with damper and stops by their lengths instead of their ends.

    `spring`, `damper`: length, and length as drawn, m; `damper`: None if it acts along the spring.
    """
    pairs = ((spring, springs),) if damper is None else zip((spring, damper), springs.beside_damper, strict=True)
    for name, ((length, drawn), alone) in zip(("spring", "damper"), pairs, strict=False):
        _add_along_line(b, f"{name} {wheel}", AffineVector((Affine(), Affine(), length)), drawn, alone)


def _add_along_line(
    b: CarBuilder, name: str, difference: AffineVector, drawn: float, springs: AxleSprings
) -> ElementRecord:
    """Add spring, damper and stops along a line between two ends. `drawn`: its length in the drawing, m."""
    spring, damper, stops = springs.spring, springs.damper, springs.stops
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
    if spring is not None:
        b.tie_numbers(spring, element)
        b.tie(spring, "factor", element, "stiffness_factor")
    if damper is not None:
        b.tie_numbers(damper, element)
        b.tie(damper, "factor", element, "damping_factor")
    return element
