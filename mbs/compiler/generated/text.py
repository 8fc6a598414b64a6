"""Text of generated C: neighbouring numbers are read and written as vectors of four."""

from collections.abc import Iterable, Sequence
from itertools import pairwise

VECTORS = """\
#ifdef __x86_64__
#define AVX2 1
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#else
#define AVX2 0
#endif
"""
"""Enables AVX2 for the following functions if the target may have it."""
NO_VECTORS = "#define AVX2 0\n"
END = """\
#if AVX2 && defined(__clang__)
#pragma clang attribute pop
#elif AVX2
#pragma GCC pop_options
#endif
#endif
"""
HEAD = """\
/* Generated for one System: the algebra of its steps. */
#include <math.h>

#include "generated.h"

#ifdef ALI3_GENERATES
INSTRUCTIONS
/* A System without rows, or whose fronts have one coordinate, does not need every argument of a function. */
#pragma GCC diagnostic ignored "-Wunused-parameter"
typedef double four __attribute__((vector_size(32), aligned(8), may_alias));
typedef double two __attribute__((vector_size(16), aligned(8), may_alias));
#define V(p) (*(const four *)(p))
#define P(p) (*(const two *)(p))
#define PUT(p, a) (*(four *)(p) = (a))
#define NONE ((four){0})
#define LOW(a, b) __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define HIGH(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define NEAR(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define FAR(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#define FIRST(a) __builtin_shufflevector(a, NONE, 0, 4, 5, 6)
#define FIRST2(a) __builtin_shufflevector(a, NONE, 0, 1, 4, 5)
#define FIRST3(a) __builtin_shufflevector(a, NONE, 0, 1, 2, 4)
#define WIDE(a) __builtin_shufflevector(a, (two){0}, 0, 1, 2, 3)
#define DIAGONAL(a, b, c) ((four){(a)[0], (b)[1], (c)[2], 0.0})
#define APART __attribute__((noinline)) static
#define HELPER static inline __attribute__((unused))

HELPER void put3(double *to, four a) {
  *(two *)to = __builtin_shufflevector(a, a, 0, 1);
  to[2] = a[2];
}

/* A pivot must neither vanish beside the mass of its coordinate nor be infinite. */
HELPER int good(double d, double floor) { return fabs(d) > 1e-14 * floor && fabs(d) < 1e300; }

/* (a0 + a1) + (a2 + a3) of each. */
HELPER four sums(four a, four b, four c, four d) {
  const four x = LOW(a, b) + HIGH(a, b), y = LOW(c, d) + HIGH(c, d);
  return NEAR(x, y) + FAR(x, y);
}

HELPER double sum(four a) { return (a[0] + a[1]) + (a[2] + a[3]); }
"""


def are_consecutive(indices: Sequence[int | None]) -> bool:
    """Whether each index is the previous one plus 1."""
    return None not in indices and all(b == a + 1 for a, b in pairwise(indices))  # type: ignore[operator]


def vector(array: str, indices: Sequence[int | None], end: int | None = None) -> str:
    """C expression of the entries of an array at three or four indices as a vector, or of one entry; None: zero.

    `end`: number of entries that may be read.
    """
    if len(indices) == 1:
        return "0.0" if indices[0] is None else f"{array}[{indices[0]}]"
    first = indices[0]
    if are_consecutive(indices) and first is not None and (end is None or first + 4 <= end):
        return f"V({array} + {first})"
    if all(i == first for i in indices) and first is not None:
        return f"{array}[{first}]"
    return literal(["0.0" if i is None else f"{array}[{i}]" for i in indices])


def literal(numbers: Sequence[str]) -> str:
    """C vector of up to four numbers, zero after them."""
    return "(four){" + ", ".join([*numbers, *["0.0"] * (4 - len(numbers))]) + "}"


def declare_array(name: str, numbers: int) -> str:
    """C declaration of an array; an empty one gets one unused number with a value, as compilers demand."""
    return f"  double {name}[{numbers}];" if numbers else f"  double {name}[1] = {{0.0}};"


def function(head: str, lines: Iterable[str]) -> list[str]:
    """Lines of a C function."""
    return [f"{head} {{", *lines, "}", ""]
