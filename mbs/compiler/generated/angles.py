"""C code of the second derivatives of the rows that measure angles, which the tangent adds in order."""

from collections.abc import Iterator

from mbs.compiler.generated.pattern import Pattern
from mbs.compiler.generated.text import declare_array


def _terms(pattern: Pattern, i: int) -> Iterator[tuple[int, int | None, int | None]]:
    """Number of each term of the i-th row of an angle, and entries of Phi_q of its two coordinates (None: constant)."""
    row, ptr = pattern.array["angle_row"][i], pattern.array["angle_ptr"]
    first = pattern.row_ptr[row]
    for t in range(ptr[i], ptr[i + 1]):
        a, b = pattern.array["angle_a"][t], pattern.array["angle_b"][t]
        yield t, first + a if a >= 0 else None, first + b if b >= 0 else None


def _theta_entry(pattern: Pattern, i: int) -> int:
    return int(pattern.row_ptr[pattern.array["angle_row"][i]] + pattern.array["angle_theta"][i])


def positions(pattern: Pattern) -> Iterator[tuple[int, int]]:
    """Row and position in front storage of each number that `lines` computes."""
    for i, row in enumerate(pattern.array["angle_row"]):
        theta = _theta_entry(pattern, i)
        for _, a, b in _terms(pattern, i):
            if a is not None and b is not None:
                yield row, pattern.product_position(row, a, b)
            yield from ((row, pattern.product_position(row, theta, x)) for x in (a, b) if x is not None)
        yield row, pattern.product_position(row, theta, theta)


def lines(pattern: Pattern) -> list[str]:
    """C that computes the second derivatives into `angle`, as the kernel does (rows/constraints.c)."""
    code = [declare_array("angle", sum(1 for _ in positions(pattern)))]
    first = 0
    for i, row in enumerate(pattern.array["angle_row"]):
        theta = f"parts->q[{pattern.row_col[_theta_entry(pattern, i)]}]"
        code += ["  {", "  double value = 0.0;"]
        code.append(f"  const double cosine = factor[{row}] * parts->cosine({theta});")
        code.append(f"  const double sine = factor[{row}] * parts->sine({theta});")
        for t, a, b in _terms(pattern, i):
            qa, qb = ("1.0" if x is None else f"parts->q[{pattern.row_col[x]}]" for x in (a, b))
            hc, hs = f"parts->angle_hc[{t}]", f"parts->angle_hs[{t}]"
            code.append(f"  {{ const double h = cosine * {hs} - sine * {hc};")
            code.append(f"    const double mixed = -(sine * {hs} + cosine * {hc});")
            code.append(f"    value += h * {qa} * {qb};")
            numbers = ["2.0 * h" if a == b else "h"] if a is not None and b is not None else []
            numbers += [f"mixed * {other}" for x, other in ((a, qb), (b, qa)) if x is not None]
            code += [f"    angle[{first + k}] = {number};" for k, number in enumerate(numbers)]
            code += ["    (void)mixed; }"]
            first += len(numbers)
        code += [f"  angle[{first}] = -value;", "  }"]
        first += 1
    return code
