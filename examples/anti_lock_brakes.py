"""A slip controller in a second FMU stops a car, wet or on ice: python examples/anti_lock_brakes.py [PICTURE]"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pythonfmu import FmuBuilder

from hosts.fmu.fmu import Fmu
from hosts.plant import Car

CONTROLLER = Path(__file__).parent / "controllers" / "slip_controller.py"
STEP, SPEED, WHEELS = 0.004, 22.0, ("FL", "FR", "RL", "RR")  # s, m/s
READS = ("chassis.x", "speed", "chassis.yaw", "chassis.wz", "chassis.y", *(f"wheel_{w}.omega" for w in WHEELS))


def stop(plant, controller, on, start):
    """Rows of way, speed and yaw angle; a driver holds the heading by the steering."""
    rows = []
    plant.reset(**{"initial.speed": SPEED, "selector": 0, **start})
    controller.initialise({})
    give = controller.setter(["speed", "on", *(f"omega_{w}" for w in WHEELS)])
    take = controller.getter([f"torque_{w}" for w in WHEELS])
    while not rows or rows[-1][1] > 0.3:
        rows.append(plant.read(READS))
        _, speed, yaw, yaw_rate, y, *omega = rows[-1].tolist()
        give([speed, on, *omega])
        controller.step(plant.time, STEP)
        plant.step([np.clip(-4.0 * yaw - 0.6 * yaw_rate - 0.15 * y, -1.0, 1.0), *take()])
    return np.array(rows)[:, :3]


def main(picture: str = "anti_lock_brakes.png", car: str = "prototype") -> float:
    """Ratio of the stopping distances with the controller and with locked wheels, on a wet road."""
    figure, distances = Figure(figsize=(9.0, 3.6), layout="constrained"), {}
    panels = dict(zip(("wet", "split"), figure.subplots(1, 2), strict=True))
    inputs = ["steering", *(f"wheel_{w}.brake_torque_demand" for w in WHEELS)]
    with tempfile.TemporaryDirectory() as folder, Car(car, ports="brakes", step=STEP, inputs=inputs) as plant:
        path = Path(FmuBuilder.build_FMU(CONTROLLER, dest=folder))
        for road, start in (("wet", {"road.friction": 0.5}), ("split", {"road.file": "split.road"})):
            for on, label in ((0.0, "locked"), (1.0, "controlled")):
                with Fmu(path) as controller:
                    rows = stop(plant, controller, on, start)
                rows[:, 2] = np.unwrap(rows[:, 2])
                distances[road, on], yaw = rows[-1, [0, 2]]
                print(f"{road} road, wheels {label}: stands after {distances[road, on]:.1f} m, turned by {yaw:.2f} rad")
                panels[road].plot(rows[:, 0], rows[:, 1 if road == "wet" else 2], label=label)
    panels["wet"].set(xlabel="way, m", ylabel="speed, m/s", title="wet road")
    panels["split"].set(xlabel="way, m", ylabel="yaw angle, rad", title="right wheels on ice")
    panels["wet"].legend()
    figure.savefig(picture, dpi=90)
    return float(distances["wet", 1.0] / distances["wet", 0.0])


if __name__ == "__main__":
    main(*sys.argv[1:])
