"""Two motions compared by the kernel, as an FMU compares them; see `ali3_compare`."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import POINTER, c_double
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import load_library
from mbs.kernel.header.enumerations import JudgedKind, JudgedUnit
from mbs.kernel.header.structures import ComparedFields, JudgedFields
from mbs.results.comparison import COORDINATES, Compared

Array = NDArray[np.float64]
JUDGED_UNITS = {
    "m": JudgedUnit.M,
    "rad": JudgedUnit.RAD,
    COORDINATES: JudgedUnit.COORDINATE,
    "N": JudgedUnit.N,
    "m/s": JudgedUnit.M_S,
    "rad/s": JudgedUnit.RAD_S,
    "N m": JudgedUnit.N_M,
}


def kind_of(what: Compared) -> int:
    """`ali3_judged.kind`."""
    bits = {
        JudgedKind.PLACE: what.place,
        JudgedKind.LOAD: what.load,
        JudgedKind.ALWAYS: what.always,
        JudgedKind.WRAPPED: what.wrapped,
    }
    return sum(bit for bit, is_set in bits.items() if is_set)


def compared(
    coarse: Mapping[str, Array], fine: Mapping[str, Array], judged: Mapping[str, Compared], length: float, guided: bool
) -> tuple[dict[str, float], dict[str, float]]:
    """What two motions differ by at their samples, and what that is held against.

    Parameters
    ----------
    coarse, fine : mapping of str to array of shape (n,)
        By name, at the same samples; sizes are those of the finer one.
    judged : mapping of str to Compared
        What is compared.
    length : float
        Of the model, m.
    guided : bool
        Whether places that are the same in both do not move by themselves.

    Returns
    -------
    gaps : dict of str to float
        Largest differences.
    sizes : dict of str to float
        Of those that count.
    """
    names, library = list(judged), load_library()
    what = (JudgedFields * len(names))(*(JudgedFields(JUDGED_UNITS[w.unit], kind_of(w)) for w in judged.values()))
    seen, size = (ComparedFields * len(names))(), np.zeros(len(names))
    rows = [np.column_stack([np.asarray(run[name], float) for name in names]) for run in (coarse, fine)]
    time, *motions = (_doubles(np.ascontiguousarray(a)) for a in (np.arange(float(len(rows[0]))), *rows))
    library.ali3_compare(what, len(names), len(rows[0]), time, *motions, seen)
    library.ali3_compared_sizes(what, len(names), seen, length, guided, _doubles(size))
    sizes = {name: float(of) for name, of in zip(names, size, strict=True) if of > 0.0}
    return {name: s.gap for name, s in zip(names, seen, strict=True) if name in sizes}, sizes


def _doubles(values: Array) -> Any:
    return values.ctypes.data_as(POINTER(c_double))
