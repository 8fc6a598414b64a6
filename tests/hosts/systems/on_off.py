"""A controller that switches in a second FMU: errors of distances over the communication step.

python -m tests.hosts.systems.on_off
"""

from functools import cache

import numpy as np

from hosts.systems import CoupledFmus
from hosts.systems.coupled_fmus import INPUTS, Inputs
from tests.hosts.systems.controlled import INNER, SLIP_WIRES
from tests.hosts.systems.weak_coupling import car_fmu, partner_fmu, percent

BRAKING_TIME = 2.0  # s
SHORT = 1e-4  # s, step of the reference
BRAKING_DISTANCE = 21.546237292590998  # m, `braking_distance(SHORT)`, which takes 4 s; a test repeats it


@cache
def distance_with_shifts(step: float, inputs: Inputs = "held") -> float:
    """Distance of the prototype in 2.5 s of throttle and 1.5 s of brakes whose gears a second FMU asks for, m."""
    parts = {"car": car_fmu("prototype", "gear"), "law": partner_fmu("shift_law")}
    wires = {f"law.{n}": f"car.{n}" for n in ("engine_speed", "gear")} | {"car.gear_request": "law.request"}
    with CoupledFmus(parts, wires, step=step, inputs=inputs) as system:
        system.initialise(**{"car.initial.speed": 3.0, "car.throttle": 0.7, "car.step_size": min(step, INNER)})
        rows = [system.run(2.5, ("car.chassis.x", "law.request"))]
        system.fmu("car").setter(["throttle", "brake"])([0.0, 0.4])
        rows.append(system.run(1.5, ("car.chassis.x", "law.request")))
    assert set(np.concatenate(rows)[:, 1]) == {1.0, 2.0, 3.0}, "it shifts up and down"
    return float(rows[1][-1, 0] - rows[0][0, 0])


@cache
def braking_distance(step: float, inputs: Inputs = "held") -> float:
    """Distance of the prototype from 15 m/s on a wet road in `BRAKING_TIME`, m."""
    parts = {"car": car_fmu("prototype", "brakes"), "controller": partner_fmu("on_off_brakes")}
    start = {"car.initial.speed": 15.0, "car.road.friction": 0.5, "car.selector": 0, "car.step_size": min(step, INNER)}
    with CoupledFmus(parts, SLIP_WIRES, step=step, inputs=inputs) as system:
        system.initialise(**start)
        rows = system.run(BRAKING_TIME, ("car.chassis.x",))
    return float(rows[-1, 0] - rows[0, 0])


def error(step: float, inputs: Inputs) -> float:
    """Relative error of the braking distance against that with the step `SHORT`."""
    return abs(braking_distance(step, inputs) / BRAKING_DISTANCE - 1.0)


def main() -> None:
    """Print the numbers of the page on systems, and `BRAKING_DISTANCE`."""
    print(f"BRAKING_DISTANCE = {braking_distance(SHORT)!r}", flush=True)
    shifts = (
        f"{1e3 * h:g} ms {percent(abs(distance_with_shifts(h) / distance_with_shifts(SHORT) - 1.0))}"
        for h in (0.001, 0.002, 0.004, 0.01)
    )
    print("gears: " + ", ".join(shifts), flush=True)
    for inputs in INPUTS:
        print(f"{inputs}: " + ", ".join(percent(error(h, inputs)) for h in (0.001, 0.002, 0.004, 0.01)), flush=True)


if __name__ == "__main__":
    main()
