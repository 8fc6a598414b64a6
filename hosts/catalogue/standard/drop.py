"""Free fall onto four wheels: a test of the springs, the stops and of the balance of forces at rest."""

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import held

STEP = 0.002  # s; a peak of the load lasts some 10 ms


def drive(sheet: Sheet) -> None:
    """One fall."""
    car = sheet.with_step_up_to(STEP, "the peak of the load")
    inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.3}
    fall = held(car, "drop", sheet.settings["duration"], inputs, {"initial.z": sheet.settings["height"]})
    run = sheet.keep("drop", car.drive(fall))
    sheet.progress(1.0)
    sheet.add("fall", run=run)
