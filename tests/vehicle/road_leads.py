"""Table of errors of a road in another program by the time of its request within a step.

python -m tests.vehicle.road_leads
"""

import numpy as np

import mbs
from hosts.fmu.fmu import Fmu
from mbs.elements.road import ANSWER
from tests.hosts.systems.weak_coupling import car_fmu
from tests.vehicle.cars_with_ports import WHEELS
from tests.vehicle.test_road_port import FRICTION, Waves, closed, drive

STEP = 0.002  # s
COUNT = 500


def loads_of_fmu(waves: Waves, speed: float, lead: float = 1.0) -> tuple[float, list[str]]:
    """Error of the wheel loads of the FMU over 1 s with requests `lead` steps ahead, rms over mean, and its
    messages.
    """
    model = mbs.Simulation(closed(waves), pose=mbs.Pose(speed=speed))
    model.set_input("throttle", 0.3)
    point, names = "road_ahead" if lead else "contact", [f"wheel_{w}.Fz" for w in WHEELS]
    with Fmu(car_fmu(waves.car, "road")) as fmu:
        fmu.initialise({"initial.speed": speed, "ports.road_lead": lead, "throttle": 0.3})
        requested = fmu.getter([f"wheel_{w}.{point}_{c}" for w in WHEELS for c in "xy"])
        write = fmu.setter(["steering", *(f"wheel_{w}.road_{n}" for w in WHEELS for n in ANSWER)])
        read, loads = fmu.getter(names), []
        for k in range(COUNT):
            steering = float(0.05 * np.sin(2.0 * STEP * k))
            row = [steering]
            for x, y in np.reshape(requested(), (4, 2)).tolist():
                size = float(np.hypot(1.0, waves.slope(x)))
                row += [x, y, waves.height(x), -waves.slope(x) / size, 0.0, 1.0 / size, FRICTION]
            write(row)
            fmu.step(STEP * k, STEP)
            model.set_input("steering", steering)
            model.step(STEP)
            loads.append([[model.sensors[n] for n in names], read()])
        messages = list(fmu.messages)
    fz = np.array(loads)
    return float(np.sqrt(np.mean((fz[:, 0] - fz[:, 1]) ** 2)) / fz[:, 0].mean()), messages


if __name__ == "__main__":
    print("| car | waves | speed, m/s | at its start | in its middle | at its end | at its end, the FMU |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for car in ("hatchback", "prototype"):
        for length, high in ((1.0, 0.008), (2.0, 0.03), (5.0, 0.08)):
            for speed in (10.0, 25.0, 40.0):
                waves = Waves(car, length, 0.5 * high)
                errors = [drive(STEP, "in turn", lead, speed, waves)["load"] for lead in (0.0, 0.5, 1.0)]
                errors.append(loads_of_fmu(waves, speed)[0])
                cells = " | ".join(f"{100.0 * load:.2g} %" for load in errors)
                print(f"| {car} | {1e3 * high:g} mm, {length:g} m | {speed:g} | {cells} |", flush=True)
