"""Constraint rows as quadratic polynomials of the coordinates z, by monomials."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import chain

from mbs.common.affine import Affine
from mbs.model.equation import Equation, Product

Monomial = tuple[int, int]
"""(i, j) with i >= j for z_i z_j, (i, -1) for z_i, (-1, -1) for 1."""
Polynomial = dict[Monomial, float]
RateTerms = dict[tuple[int, int], float]
"""(i, j) for z_i dz_j/dt, (-1, j) for dz_j/dt."""

DROP = 1e-12
"""Coefficients below this part of the largest of their row count as zero."""
VANISHED = 1e-10
"""A row vanishes if its coefficients are below this part of its summed terms, or of its largest one so far."""
ERROR_FACTOR = 50.0
"""Largest remainder of a row that follows from others, in multiples of the error of the drawing."""


@dataclass
class RowTerms:
    """One constraint row over z."""

    name: str
    """Name of its joint or body."""
    kind: str
    """Kind of its condition."""
    joint: int
    """Number of its joint, or -1 for rows of rigid bodies."""
    equation_number: int
    """Number of the equation of the joint, or -1 for rows of rigid bodies."""
    main: Polynomial
    """Quadratic part."""
    theta: int = -1
    """Coordinate of the angle part, or -1."""
    cosine: Polynomial = field(default_factory=dict)
    """C of the angle part ``cos(theta) S - sin(theta) C``."""
    sine: Polynomial = field(default_factory=dict)
    """S of the angle part."""
    guides: list[tuple[int, int, Polynomial]] = field(default_factory=list)
    switch: int = -1
    """Number of the switch that turns it on and off, or -1."""
    rates: RateTerms = field(default_factory=dict)
    """Terms of a condition on velocities, which has no other part."""

    @property
    def is_plain(self) -> bool:
        """Whether it has a quadratic part only and no switch."""
        return self.theta < 0 and not self.guides and self.switch < 0 and not self.rates

    def columns(self) -> list[int]:
        """Coordinates it depends on, ascending."""
        polynomials = (self.main, self.cosine, self.sine, self.rates, *(g[2] for g in self.guides))
        columns = {*chain.from_iterable(chain.from_iterable(polynomials))}
        columns.add(self.theta)
        columns.discard(-1)
        return sorted(columns)


def substitute(expression: Affine, full: Sequence[Affine]) -> Affine:
    """An expression in full coordinates as one in z; `full`: full coordinates as expressions in z."""
    terms: dict[int, float] = {}
    largest: dict[int, float] = {}  # largest term of each sum of several terms
    constant, largest_constant = expression.constant, abs(expression.constant)
    for i, c in expression.terms.items():
        of_z = full[i]
        if of_z.constant:
            product = c * of_z.constant
            constant += product
            largest_constant = max(largest_constant, abs(product))
        for j, v in of_z.terms.items():
            product = c * v
            previous = terms.get(j)
            if previous is None:
                terms[j] = product
            else:
                largest[j] = max(largest.get(j, abs(previous)), abs(product))
                terms[j] = previous + product
    if largest or 0.0 in terms.values():
        terms = {j: v for j, v in terms.items() if abs(v) > DROP * largest.get(j, 0.0)}
    return Affine(terms, constant if abs(constant) > DROP * largest_constant else 0.0)


def add_product(polynomial: Polynomial, factor: float, a: Affine, b: Affine, largest: list[float]) -> None:
    """Add ``factor * a * b`` of expressions in z, and update bounds `largest` of added terms of degrees 0, 1, 2."""
    if factor == 0.0:
        return
    terms_a = [*a.terms.items(), (-1, a.constant)] if a.constant else list(a.terms.items())
    terms_b = [*b.terms.items(), (-1, b.constant)] if b.constant else list(b.terms.items())
    for i, u in terms_a:
        for j, v in terms_b:
            m = (i, j) if i >= j else (j, i)
            polynomial[m] = polynomial.get(m, 0.0) + factor * u * v
    p, q = (max(map(abs, e.terms.values()), default=0.0) for e in (a, b))
    degrees = abs(a.constant * b.constant), max(p * abs(b.constant), q * abs(a.constant)), p * q
    largest[:] = [max(most, abs(factor) * size) for most, size in zip(largest, degrees, strict=True)]


def drop_round_off(
    p: Polynomial, size: float = 1.0, largest: Sequence[float] = (0.0, 0.0, 0.0), error: float = 0.0
) -> Polynomial:
    """The polynomial without coefficients that are round-off of the largest, at coordinates of 1 m and of `size`, m.

    Both lengths are needed because in x^2 + y^2 - L^2 of a body of a micrometre L^2 is not round-off of 1. `largest`:
    largest summed term of each degree; a sum may be round-off of it or, in a drawing corrected by `error` (parts of its
    size), a remainder of the correction.
    """
    significant: set[Monomial] = set()
    vanished = max(VANISHED, ERROR_FACTOR * error)
    for unit in {1.0, size}:
        unit_by_degree = (1.0, unit, unit * unit)
        sizes = {m: abs(v) * unit_by_degree[(m[0] >= 0) + (m[1] >= 0)] for m, v in p.items()}
        largest_size = max(sizes.values(), default=0.0)
        added = max(
            min(1.0, size) * min(unit_by_degree), *(v * w for v, w in zip(largest, unit_by_degree, strict=True))
        )
        if largest_size > vanished * added:
            significant.update(m for m, v in sizes.items() if v > DROP * largest_size)
    return {m: v for m, v in p.items() if m in significant}


def expand(
    products: Sequence[Product], linear: Affine, full: Sequence[Affine], size: float, error: float = 0.0
) -> Polynomial:
    """Polynomial in z of a sum of products and a linear part.

    `size`: size of the model, m; `error`: see `drop_round_off`.
    """
    p: Polynomial = {}
    largest = [0.0, 0.0, 0.0]
    cache: dict[int, Affine] = {}

    def of_z(a: Affine) -> Affine:
        expression = cache.get(id(a))
        if expression is None:
            expression = cache[id(a)] = substitute(a, full)
        return expression

    for factor, a, b in products:
        add_product(p, factor, of_z(a), of_z(b), largest)
    add_product(p, 1.0, substitute(linear, full), Affine({}, 1.0), largest)
    return drop_round_off(p, size, largest, error)


def expand_rates(products: Sequence[Product], full: Sequence[Affine]) -> RateTerms:
    """Terms in z of a sum of ``c * A * dB/dt``."""
    terms: RateTerms = {}
    for factor, a, b in products:
        value, rate = substitute(a, full), substitute(b, full)
        for i, u in [*value.terms.items(), (-1, value.constant)]:
            for j, v in rate.terms.items():
                terms[i, j] = terms.get((i, j), 0.0) + factor * u * v
    tolerance = DROP * max((abs(v) for v in terms.values()), default=0.0)
    return {m: v for m, v in terms.items() if abs(v) > tolerance}


def row_terms(
    equation: Equation, joint: int, equation_number: int, full: Sequence[Affine], size: float, error: float = 0.0
) -> RowTerms:
    """An equation of a joint as a row over z; `size`: size of the model, m; `error`: see `drop_round_off`."""
    products = expand(equation.products, equation.linear, full, size, error)
    row = RowTerms(equation.name, equation.kind, joint, equation_number, products)
    if equation.angle is not None:
        theta = substitute(Affine({equation.angle.theta: 1.0}), full)
        row.theta = next(iter(theta.terms))  # angle coordinates are never eliminated
        row.cosine = expand(equation.angle.cosine, Affine(), full, size)
        row.sine = expand(equation.angle.sine, Affine(), full, size)
    row.rates = expand_rates(equation.rates, full)
    row.guides = [(g.guide, g.power, expand(g.products, g.linear, full, size)) for g in equation.guides]
    return row
