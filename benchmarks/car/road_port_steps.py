"""Steps of a car through FMPy, on a road of its own or with answers at its road ports; valgrind counts them.

python -m benchmarks.car.road_port_steps FOLDER ROAD STEPS, with a folder that an FMU is unpacked in, and the file of
its own road or the amplitude of the waves that are answered, m.
"""

from __future__ import annotations

import math
import sys

import fmpy
from fmpy.simulation import instantiate_fmu

STEP, SPEED, LENGTH, FRICTION = 0.002, 10.0, 2.0, 0.9  # s, m/s, m of a wave, 1
WHEELS, ANSWER = ("FL", "FR", "RL", "RR"), ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")
WAVE = 2.0 * math.pi / LENGTH


def height(x: float, amplitude: float) -> float:
    """Of the waves, m, level at x = 0."""
    return amplitude * (1.0 - math.cos(WAVE * x))


def answers(places: list[float], amplitude: float) -> list[float]:
    """The plane that touches the waves at each point asked for, as the ports take it."""
    told: list[float] = []
    for k in range(0, len(places), 2):
        x, y = places[k : k + 2]
        slope = amplitude * WAVE * math.sin(WAVE * x)
        size = math.hypot(1.0, slope)
        told += (x, y, height(x, amplitude), -slope / size, 0.0, 1.0 / size, FRICTION)
    return told


def main(folder: str, road: str, steps: str) -> None:
    """Start the car and make the steps."""
    description = fmpy.read_model_description(folder)
    reference = {v.name: v.valueReference for v in description.modelVariables}
    car = instantiate_fmu(folder, description)
    car.setupExperiment(startTime=0.0)
    car.setReal([reference["initial.speed"]], [SPEED])
    inputs, ported = [reference["steering"], reference["throttle"]], "road.file" not in reference
    place = "road_ahead" if ported else "contact"
    asked = [reference[f"wheel_{w}.{place}_{c}"] for w in WHEELS for c in "xy"]
    if ported:
        inputs += [reference[f"wheel_{w}.road_{name}"] for w in WHEELS for name in ANSWER]
    else:
        car.setString([reference["road.file"]], [road])  # without a name the plane

    def told() -> list[float]:
        places = car.getReal(asked)
        return [0.1, 0.2, *(answers(places, float(road)) if ported else ())]

    car.enterInitializationMode()
    car.setReal(inputs, told())
    car.exitInitializationMode()
    for k in range(int(steps)):
        car.setReal(inputs, told())
        car.doStep(currentCommunicationPoint=k * STEP, communicationStepSize=STEP)
    speed = car.getReal([reference["speed"]])[0]
    if not abs(speed - SPEED) < 1.0:
        raise RuntimeError(f"The car has {speed:g} m/s after {steps} steps, begun at {SPEED:g} m/s.")


if __name__ == "__main__":
    main(*sys.argv[1:])
