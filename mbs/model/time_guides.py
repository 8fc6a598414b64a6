"""Guides that are given in time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline, PPoly

from mbs.common.checks import LARGEST, array, shown
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import GuideType
from mbs.model.guides import new_guide
from mbs.model.mechanism import Mechanism
from mbs.model.records import Guide


class TimeGuideVocabulary(Mechanism):
    """Prescribed motions in time."""

    def guide_time(self, name: str, motion: PPoly | tuple[ArrayLike, ArrayLike], *, unit: str = "1") -> Guide:
        """A prescribed motion in time; it stands still outside its pieces, so it should begin and end with zero rates.

        Parameters
        ----------
        motion : scipy.interpolate.PPoly or (times, values)
            Pieces of degree 5 or less over s; or points, of shape (n,) each, through which a cubic spline goes that
            begins and ends at rest.
        unit : str
            Of the guide, rad or m.

        Raises
        ------
        ModelError
            The degree is above 5, or the times do not rise.
        """
        pieces = motion if isinstance(motion, PPoly) else _spline(motion, f"guide '{name}'")
        c, b = np.asarray(pieces.c, dtype=float), np.asarray(pieces.x, dtype=float)
        if c.ndim != 2 or c.shape[0] > 6:
            raise ModelError(f"The motion of guide '{name}' must be one scalar motion of degree 5 or less.")
        if not (np.all(np.abs(c) < LARGEST) and np.all(np.abs(b) < LARGEST) and np.all(np.diff(b) > 0.0)):
            raise ModelError(f"The motion of guide '{name}' needs finite coefficients and rising times.")
        ascending = np.zeros((c.shape[1], 6))
        ascending[:, : c.shape[0]] = c[::-1].T
        reals = [float(c.shape[1]), *b, *ascending.ravel()]
        start = float(pieces(min(max(0.0, b[0]), b[-1])))
        return new_guide(self, name, GuideType.OF_TIME, -1, reals, start, unit)


def _spline(motion: tuple[ArrayLike, ArrayLike], what: str) -> CubicSpline:
    """A spline through points that begins and ends at rest."""
    if not isinstance(motion, (tuple, list)) or len(motion) != 2:
        raise ModelError(f"The motion of {what} must be a PPoly or (times, values), not {shown(motion)}.")
    times = array(motion[0], (None,), f"the times of {what}")
    values = array(motion[1], (None,), f"the values of {what}")
    if len(times) < 2 or len(times) != len(values) or not np.all(np.diff(times) > 0.0):
        raise ModelError(
            f"The motion of {what} has {len(times)} times and {len(values)} values; it needs two or more rising times "
            "and a value for each."
        )
    return CubicSpline(times, values, bc_type="clamped")
