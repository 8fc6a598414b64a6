"""Measures of series with sine with dwell steering, and the limits that they must keep."""

from __future__ import annotations

import math

from hosts.catalogue.dwell_series import DwellRun
from hosts.measures.measure import Limit, Measure

LAW = "49 CFR 571.126"
EARLY, LATE = 0.35, 0.20
"""Largest yaw rates 1.00 and 1.75 s after the completion of steer, over the second peak."""


def least_displacement(gross_mass: float) -> float:
    """Lateral displacement that is demanded of a car of a gross mass in kg, m."""
    return 1.83 if gross_mass <= 3500.0 else 1.52


def _worst(values: list[float]) -> float:
    """The largest; NaN if one is missing."""
    return math.nan if not values or any(map(math.isnan, values)) else max(values)


def measures_of_dwell(
    a: float, ramps: list[float], sides: list[list[DwellRun]], wanted: list[float], least: float
) -> list[Measure]:
    """Measures of the series to both sides, with the limits of the regulation.

    Parameters
    ----------
    a : float
        Angle at 0.3 g, rad.
    ramps : list of float
        The same of the ramp to the left and to the right, rad.
    sides : list of list of DwellRun
        Left and right.
    wanted : list of float
        Amplitudes of the whole series, rad.
    least : float
        Displacement that is demanded, m.
    """
    every = [r for side in sides for r in side]
    turned = [r for r in every if r.amplitude >= 4.995 * a]
    lost = (
        "A run ended before it: the car rolled over or the FMU refused a step."
        if any(not r.run.whole for r in every)
        else ""
    )
    moved = [r.measures.displacement for r in turned]
    # a side that was lost before has none, and does not pass by the other one
    shown = all(any(r.amplitude >= 4.995 * a for r in side) for side in sides) and not any(map(math.isnan, moved))
    far = min(moved) if shown else math.nan
    early = Limit(f"{LAW} S5.2.1", highest=EARLY)
    late = Limit(f"{LAW} S5.2.2", highest=LATE)
    side_notes = f"Left {math.degrees(ramps[0]):.1f}°, right {math.degrees(ramps[1]):.1f}°."
    measures = [
        Measure(
            "angle_at_0_3_g", a, "rad", "A: angle of the steering wheel at 0.3 g, mean of both ramps", note=side_notes
        ),
        Measure(
            "yaw_rate_ratio_1_00",
            _worst([r.measures.ratio_1_00 for r in every]),
            "1",
            "yaw rate 1.00 s after the completion of steer over its second peak, worst of all runs",
            early,
            lost,
        ),
        Measure(
            "yaw_rate_ratio_1_75",
            _worst([r.measures.ratio_1_75 for r in every]),
            "1",
            "yaw rate 1.75 s after the completion of steer over its second peak, worst of all runs",
            late,
            lost,
        ),
        Measure(
            "displacement",
            far,
            "m",
            "lateral displacement 1.07 s after the beginning of steer, least of the runs from 5 A",
            Limit(f"{LAW} S5.2.3", lowest=least),
            "" if math.isfinite(far) else "Not both sides have runs with 5 A or more that show it.",
        ),
    ]
    for word, side in zip(("left", "right"), sides, strict=True):
        kept = 0.0
        for r in side:
            if not (r.run.whole and early.holds(r.measures.ratio_1_00) and late.holds(r.measures.ratio_1_75)):
                break
            kept = r.amplitude
        text = f"largest amplitude up to which the yaw rate stays within both limits, first to the {word}"
        note = "" if kept == wanted[-1] else f"The series goes to {math.degrees(wanted[-1]):.0f}°."
        measures.append(Measure(f"stable_amplitude.{word}", kept, "rad", text, note=note))
    slips = [r.measures.sideslip for r in every if math.isfinite(r.measures.sideslip)]
    note = "" if slips else "The car does not tell it."
    text = "largest sideslip angle of all runs"
    return [*measures, Measure("sideslip", max(slips, default=math.nan), "rad", text, note=note)]
