"""Braking on a road whose left and right side have different friction, with the steering fixed, after ISO 14512."""

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.standard.straight_braking import drive_stop

STEP = 0.005  # s; the yaw rate rises within about 0.1 s
ROAD = "split.road"  # a resource of the FMU of a car: friction 1.0 on the left, 0.15 on the right


def drive(sheet: Sheet) -> None:
    """Drive one stop, with the left and the right wheels on different friction."""
    car = sheet.with_step_up_to(STEP, "the rise of the yaw rate")
    stop = drive_stop(car, sheet.settings, {"road.file": ROAD})
    sheet.runs["split_braking"] = stop.run
    sheet.notes += stop.notes
    sheet.progress(1.0)
    sheet.add("stop", **stop.names)
