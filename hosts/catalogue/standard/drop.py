"""Free fall onto four wheels: springs, bump stops, and the balance of forces at rest."""

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import constant_inputs

STEP = 0.002  # s; a peak of the load lasts about 10 ms


def drive(sheet: Sheet) -> None:
    """Drop the car once."""
    car = sheet.with_step_up_to(STEP, "the peak of the load")
    inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.3}
    fall = constant_inputs(car, "drop", sheet.settings["duration"], inputs, {"initial.z": sheet.settings["height"]})
    run = sheet.add_run("drop", car.drive(fall))
    sheet.progress(1.0)
    sheet.add("fall", run=run)
