"""A law that is on or off in a second FMU: the error of a stop over the communication step.

python -m tests.hosts.systems.on_off
"""

from __future__ import annotations

from functools import cache

from hosts.systems import CoupledFmus
from hosts.systems.coupled import INPUTS, Inputs
from tests.hosts.systems.controlled import INNER, SLIP_WIRES
from tests.hosts.systems.weak_coupling import car_fmu, partner_fmu, percent

TIME, SHORT = 2.0, 1e-4  # s


@cache
def way(step: float, inputs: Inputs = "held") -> float:
    """Of the prototype from 15 m/s on a wet road in two seconds, m."""
    parts = {"car": car_fmu("prototype", "brakes"), "controller": partner_fmu("on_off_brakes")}
    start = {"car.initial.speed": 15.0, "car.road.friction": 0.5, "car.selector": 0, "car.step_size": min(step, INNER)}
    with CoupledFmus(parts, SLIP_WIRES, step=step, inputs=inputs) as system:
        system.initialise(**start)
        rows = system.run(TIME, ("car.chassis.x",))
    return float(rows[-1, 0] - rows[0, 0])


def error(step: float, inputs: Inputs) -> float:
    """Of the way, a share of that with steps in which the law switches nearly at once."""
    return abs(way(step, inputs) / way(SHORT) - 1.0)


def main() -> None:
    """Print the table of the page on systems."""
    for inputs in INPUTS:
        print(f"{inputs}: " + ", ".join(percent(error(h, inputs)) for h in (0.001, 0.002, 0.004, 0.01)), flush=True)


if __name__ == "__main__":
    main()
