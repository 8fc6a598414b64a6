"""Quadratic polynomials of the coordinates z as sparse tables of monomials."""

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
"""A coefficient smaller than this part of the largest of its row is a zero."""
VANISHED = 1e-10
"""A row whose coefficients are all smaller than this part of the summed terms, or of its largest one so far, vanishes;
far from the origin the round-off is larger."""
OF_ERROR = 50.0
"""Largest remainder of a row that follows from others, over the error of the drawing."""


@dataclass
class RowTerms:
    """One constraint row over z."""

    name: str
    kind: str
    """`name`, `kind`: joint or body it comes from, and what it states."""
    joint: int
    part: int
    """`joint`, `part`: number of the joint and of its equation, or -1 for rigid-body rows."""
    main: Polynomial
    """Quadratic part."""
    theta: int = -1
    """Coordinate of the angle part, or -1."""
    cosine: Polynomial = field(default_factory=dict)
    sine: Polynomial = field(default_factory=dict)
    """`cosine`, `sine`: C and S of the angle part."""
    guides: list[tuple[int, int, Polynomial]] = field(default_factory=list)
    switch: int = -1
    """Number of the switch that turns it on and off, or -1."""
    rates: RateTerms = field(default_factory=dict)
    """Of a condition on velocities, which has nothing else."""

    @property
    def plain(self) -> bool:
        """Whether it is a quadratic alone that always holds."""
        return self.theta < 0 and not self.guides and self.switch < 0 and not self.rates

    def columns(self) -> list[int]:
        """Coordinates it depends on, ascending."""
        polynomials = (self.main, self.cosine, self.sine, self.rates, *(g[2] for g in self.guides))
        columns = {*chain.from_iterable(chain.from_iterable(polynomials))}
        columns.add(self.theta)
        columns.discard(-1)
        return sorted(columns)


def substitute(expression: Affine, full: Sequence[Affine]) -> Affine:
    """An expression of full coordinates as one of z."""
    terms: dict[int, float] = {}
    largest: dict[int, float] = {}  # of what was added up, where more than one was
    constant, biggest = expression.constant, abs(expression.constant)
    for i, c in expression.terms.items():
        of_z = full[i]
        if of_z.constant:
            product = c * of_z.constant
            constant += product
            biggest = max(biggest, abs(product))
        for j, v in of_z.terms.items():
            product = c * v
            before = terms.get(j)
            if before is None:
                terms[j] = product
            else:
                largest[j] = max(largest.get(j, abs(before)), abs(product))
                terms[j] = before + product
    if largest or 0.0 in terms.values():
        terms = {j: v for j, v in terms.items() if abs(v) > DROP * largest.get(j, 0.0)}
    return Affine(terms, constant if abs(constant) > DROP * biggest else 0.0)


def add_product(into: Polynomial, factor: float, a: Affine, b: Affine, largest: list[float]) -> None:
    """Add ``factor * a * b``, expressions of z, and keep in `largest` what no added term of each degree exceeds."""
    if factor == 0.0:
        return
    terms_a = [*a.terms.items(), (-1, a.constant)] if a.constant else list(a.terms.items())
    terms_b = [*b.terms.items(), (-1, b.constant)] if b.constant else list(b.terms.items())
    for i, u in terms_a:
        for j, v in terms_b:
            m = (i, j) if i >= j else (j, i)
            into[m] = into.get(m, 0.0) + factor * u * v
    p, q = (max(map(abs, e.terms.values()), default=0.0) for e in (a, b))
    degrees = abs(a.constant * b.constant), max(p * abs(b.constant), q * abs(a.constant)), p * q
    largest[:] = [max(most, abs(factor) * size) for most, size in zip(largest, degrees, strict=True)]


def cleaned(
    p: Polynomial, size: float = 1.0, largest: Sequence[float] = (0.0, 0.0, 0.0), error: float = 0.0
) -> Polynomial:
    """The polynomial without coefficients that are round-off of the largest, at coordinates of 1 m and of `size`, m.

    Next to the 1 of x^2 + y^2 - L^2, which is no length, the L^2 of a body of a micrometre is small, not round-off.
    `largest`: largest summed term of each degree; the remainder of the sum may be round-off of it, or, in a drawing
    that was corrected by `error`, parts of its size, a remainder of the correction.
    """
    significant: set[Monomial] = set()
    vanished = max(VANISHED, OF_ERROR * error)
    for unit in {1.0, size}:
        by_degree = (1.0, unit, unit * unit)
        sizes = {m: abs(v) * by_degree[(m[0] >= 0) + (m[1] >= 0)] for m, v in p.items()}
        largest_size = max(sizes.values(), default=0.0)
        added = max(min(1.0, size) * min(by_degree), *(v * w for v, w in zip(largest, by_degree, strict=True)))
        if largest_size > vanished * added:
            significant.update(m for m, v in sizes.items() if v > DROP * largest_size)
    return {m: v for m, v in p.items() if m in significant}


def expand(
    products: Sequence[Product], linear: Affine, full: Sequence[Affine], size: float, error: float = 0.0
) -> Polynomial:
    """The polynomial of a sum of products and a linear part; `size`: of the model, m; `error`: see `cleaned`."""
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
    return cleaned(p, size, largest, error)


def expand_rates(products: Sequence[Product], full: Sequence[Affine]) -> RateTerms:
    """The terms of a sum of ``c * A * dB/dt``."""
    terms: RateTerms = {}
    for factor, a, b in products:
        value, rate = substitute(a, full), substitute(b, full)
        for i, u in [*value.terms.items(), (-1, value.constant)]:
            for j, v in rate.terms.items():
                terms[i, j] = terms.get((i, j), 0.0) + factor * u * v
    least = DROP * max((abs(v) for v in terms.values()), default=0.0)
    return {m: v for m, v in terms.items() if abs(v) > least}


def row_terms(
    equation: Equation, joint: int, part: int, full: Sequence[Affine], size: float, error: float = 0.0
) -> RowTerms:
    """An equation of a joint as a row over z; `size`: of the model, m; `error`: see `cleaned`."""
    products = expand(equation.products, equation.linear, full, size, error)
    row = RowTerms(equation.name, equation.kind, joint, part, products)
    if equation.angle is not None:
        theta = substitute(Affine({equation.angle.theta: 1.0}), full)
        row.theta = next(iter(theta.terms))  # angle coordinates are never eliminated
        row.cosine = expand(equation.angle.cosine, Affine(), full, size)
        row.sine = expand(equation.angle.sine, Affine(), full, size)
    row.rates = expand_rates(equation.rates, full)
    row.guides = [(g.guide, g.power, expand(g.products, g.linear, full, size)) for g in equation.guides]
    return row
