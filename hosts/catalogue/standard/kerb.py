"""Driving down and up a kerb: loads, travel, vertical vibration and, if computed, stresses."""

import math

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import constant_inputs
from hosts.common.numbers import Value

STEP = 0.002  # s; a wheel passes the edge within about 10 ms
AFTER = 3.0  # s after the edge


def drive(sheet: Sheet) -> None:
    """Drive down the kerb and, if the FMU has start values of pose, up."""
    car, settings = sheet.with_step_up_to(STEP, "the passage of an edge"), sheet.settings
    height, ahead = settings["height"], settings["ahead"]
    down: dict[str, Value] = {"initial.speed": settings["speed"] / 3.6}
    down |= {"road.kerb_height": height, "road.kerb_x": ahead}
    # Upwards the car starts on the low side, in the opposite direction.
    up = down | {"road.kerb_x": 0.0, "initial.x": ahead, "initial.yaw": math.pi, "initial.z": -height}
    directions = {"down": (down, -height), "up": (up, height)}
    missing = [n for n in up if n not in car.facts.parameters]
    if missing:
        del directions["up"]
    sheet.add("directions", missing=missing)
    # In neutral, without creep torque, the car rolls.
    inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.0, "selector": 0.0}
    stop_time = ahead / settings["speed"] * 3.6 + AFTER
    for direction, (start, rise) in directions.items():
        run = sheet.add_run(direction, car.drive(constant_inputs(car, f"kerb_{direction}", stop_time, inputs, start)))
        sheet.progress(len(sheet.runs) / len(directions))
        gauges = [n for n in run.names if n.startswith("stress.") and n != "stress.computed"]
        if "stress.computed" in run and not (run["stress.computed"] == 1.0).all():
            gauges = []
        sheet.add("passage", direction=direction, rise=rise, run=run, gauges=gauges)
