"""Release of the throttle on a steady circle with the steering fixed, at increasing lateral acceleration."""

import math
from collections.abc import Sequence

from hosts.catalogue.circle_stop import COMPARED, STEADY_TIME, Stop
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.standard.braking_in_a_turn import STEP, drive_stop

AFTER = 2.0  # s after the release


def drive(sheet: Sheet) -> None:
    """Drive releases at increasing lateral acceleration, until the car does not get onto the circle."""
    car, settings = sheet.with_step_up_to(STEP, "the yaw acceleration"), dict(sheet.settings)
    levels, released = round(settings["levels"]), list[tuple[float, Stop]]()
    for k in range(1, levels + 1):
        requested = settings["lowest"] + (settings["highest"] - settings["lowest"]) * (k - 1) / max(levels - 1, 1)
        release = drive_stop(
            car, settings | {"lateral_acceleration": requested, "rise_time": 0.0}, 0.0, AFTER + STEADY_TIME
        )
        sheet.add_run(f"{requested:.6g}_m_s2", release.result)
        if math.isnan(release.onset):
            sheet.add("off_circle", last=release, requested=requested)
            break
        released.append((requested, release))
        sheet.progress(k / levels)
    add_releases(sheet, released)


def add_releases(sheet: Sheet, released: Sequence[tuple[float, Stop]]) -> None:
    """Add the measures of releases. `released`: requested lateral accelerations, m/s2, with the releases."""
    release_values = [
        {"ay": r.lateral_acceleration_on_circle, "deceleration": r.deceleration, **values}
        for _, r in released
        if (values := r.values())
    ]
    rows = [{"requested": requested, "r": r} for requested, r in released]
    sheet.add("releases", compared=COMPARED, released=rows, rows=sorted(release_values, key=lambda v: v["ay"]))
