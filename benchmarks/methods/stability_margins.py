"""Margins of the default settings in the maps of `benchmarks.stability`: distances from runs that are not fine."""

from collections.abc import Sequence
from typing import Any

import numpy as np

import mbs
from benchmarks.shared.pages import Row, table

USUAL_STEP = 0.01  # s
STEP_FACTORS = {"squeezer": 0.01}  # of scenes with other time scales


def margins(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Margins by scene and method: the range of steps in which all runs with default settings are fine, and the decades
    of eps below and above the default up to the first run that is not fine, least over that range and at the usual
    step.

    The decades are None for methods without penalty.
    """
    lines = []
    for scene, method in dict.fromkeys((r["scene"], r["method"]) for r in rows if r["parameter"].startswith("eps")):
        method_rows = [r for r in rows if (r["scene"], r["method"]) == (scene, method)]
        defaults = sorted((r["h_s"], r["outcome"]) for r in method_rows if r["value"] is None)
        good = _longest([h for h, _ in defaults], [o == "fine" for _, o in defaults])
        results = (
            {h: _decades(method_rows, h) for h in good} if any(r["value"] is not None for r in method_rows) else {}
        )
        usual = min(good, key=lambda h: abs(np.log(h / (USUAL_STEP * STEP_FACTORS.get(scene, 1.0)))), default=None)
        lines.append(
            {
                "scene": scene,
                "method": method,
                "smallest_fine_h_s": good[0] if good else None,
                "largest_fine_h_s": good[-1] if good else None,
                "first_break": next((f"{o} at {h:.3g} s" for h, o in defaults if good and h > good[-1]), "-"),
                "decades_below": min((d[0] for d in results.values()), default=None),
                "decades_above": min((d[1] for d in results.values()), default=None),
                "usual_h_s": usual,
                "usual_below": results[usual][0] if usual in results else None,
                "usual_above": results[usual][1] if usual in results else None,
            }
        )
    return lines


def _decades(rows: Sequence[Row], h: float) -> tuple[float, float]:
    """Decades of eps below and above the default up to the first run that is not fine, or to one after the last."""
    centre = np.log10(mbs.Settings().eps_rel)
    values = sorted((np.log10(r["value"]), r["outcome"]) for r in rows if r["h_s"] == h and r["value"] is not None)
    lower = [v for v, o in values if o != "fine" and v < centre - 1e-9]
    upper = [v for v, o in values if o != "fine" and v > centre + 1e-9]
    below = centre - (lower[-1] if lower else values[0][0] - 1.0)
    above = (upper[0] if upper else values[-1][0] + 1.0) - centre
    return float(below), float(above)


def _longest(steps: list[float], fine: list[bool]) -> list[float]:
    """Longest sequence of steps whose runs are fine."""
    best: list[float] = []
    current: list[float] = []
    for h, good in zip(steps, fine, strict=True):
        current = [*current, h] if good else []
        best = current if len(current) > len(best) else best
    return best


def margin_table(margins: Sequence[Row]) -> str:
    """Table of the margins, a line for each scene and method."""
    columns = {"scene": "", "method": "", "smallest_fine_h_s": ".1e", "largest_fine_h_s": ".1e", "first_break": ""}
    decades = dict.fromkeys(("decades_below", "decades_above"), ".0f") | {"usual_h_s": ".0e"}
    decades |= dict.fromkeys(("usual_below", "usual_above"), ".0f")
    return table(margins, columns | decades)
