"""The throttle released on a steady circle with the steering fixed, from circles driven faster and faster."""

import math
from collections.abc import Sequence

from hosts.catalogue.circle_stop import COMPARED, STEADY, Stop
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.standard.braking_in_a_turn import STEP, stop

AFTER = 2.0  # s that are driven after the release


def drive(sheet: Sheet) -> None:
    """Releases at growing lateral acceleration, until the car does not get onto the circle."""
    car, settings = sheet.with_step_up_to(STEP, "the yaw acceleration"), dict(sheet.settings)
    levels, released = round(settings["levels"]), list[tuple[float, Stop]]()
    for k in range(1, levels + 1):
        requested = settings["lowest"] + (settings["highest"] - settings["lowest"]) * (k - 1) / max(levels - 1, 1)
        release = stop(car, settings | {"lateral_acceleration": requested, "rise_time": 0.0}, 0.0, AFTER + STEADY)
        sheet.keep(f"{requested:.6g}_m_s2", release.result)
        if math.isnan(release.onset):
            sheet.add("not_there", last=release, asked=requested)
            break
        released.append((requested, release))
        sheet.progress(k / levels)
    add_releases(sheet, released)


def add_releases(sheet: Sheet, released: Sequence[tuple[float, Stop]]) -> None:
    """The measures of releases, each with the lateral acceleration that was asked for."""
    release_values = [
        {"ay": r.lateral_acceleration_on_circle, "deceleration": r.deceleration, **values}
        for _, r in released
        if (values := r.values())
    ]
    rows = [{"asked": requested, "r": r} for requested, r in released]
    sheet.add("releases", compared=COMPARED, released=rows, known=sorted(release_values, key=lambda v: v["ay"]))
