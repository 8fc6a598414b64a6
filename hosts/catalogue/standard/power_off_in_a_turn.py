"""The throttle released on a steady circle with the steering fixed, from circles driven faster and faster."""

from __future__ import annotations

import math

from hosts.catalogue.circle_stop import COMPARED, STEADY, Stop
from hosts.catalogue.sheet import Sheet
from hosts.catalogue.standard.braking_in_a_turn import STEP, stop

AFTER = 2.0  # s that are driven after the release


def drive(sheet: Sheet) -> None:
    """Releases at growing lateral acceleration, until the car does not get onto the circle."""
    car, settings = sheet.with_step_up_to(STEP, "the yaw acceleration"), dict(sheet.settings)
    levels, released = round(settings["levels"]), list[Stop]()
    for k in range(1, levels + 1):
        asked = settings["lowest"] + (settings["highest"] - settings["lowest"]) * (k - 1) / max(levels - 1, 1)
        made = stop(car, settings | {"lateral_acceleration": asked, "rise_time": 0.0}, 0.0, AFTER + STEADY)
        sheet.keep(f"{asked:.3g}_m_s2", made.result)
        if math.isnan(made.onset):
            sheet.add("not_there", last=made, asked=asked)
            break
        released.append(made)
        sheet.progress(k / levels)
    add_releases(sheet, released)


def add_releases(sheet: Sheet, released: list[Stop]) -> None:
    """The measures of releases with growing lateral acceleration."""
    known = [
        {"ay": r.before("speed") ** 2 / r.circle[2], "deceleration": r.deceleration, **values}
        for r in released
        if (values := r.values())
    ]
    sheet.add("releases", compared=COMPARED, released=released, known=sorted(known, key=lambda v: v["ay"]))
