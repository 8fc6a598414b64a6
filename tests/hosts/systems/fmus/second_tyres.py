"""Copies of the tyres of the hatchback in a second FMU."""

from typing import Any

from tests.hosts.systems.partner import Partner
from tests.vehicle.cars_with_ports import hatchback
from tests.vehicle.second_tyres import HUB, WHEELS, SecondTyre

READ = (
    *("x", "y", "z", "axis_x", "axis_y", "axis_z"),
    *("earth_vx", "earth_vy", "earth_vz", "axis_rate_x", "axis_rate_y", "axis_rate_z", "omega"),
)


class TyresPartner(Partner):
    """Computes the wrenches on the hubs from the motions of the hubs alone."""

    inputs = tuple(f"wheel_{w}.{n}" for w in WHEELS for n in READ)
    outputs = (*(f"wheel_{w}.{n}" for w in WHEELS for n in HUB), *(f"wheel_{w}.load" for w in WHEELS))

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.tyres = [SecondTyre(w, hatchback()) for w in WHEELS]

    def find(self, step: float) -> None:
        for tyre in self.tyres:
            wrench, self.value[f"wheel_{tyre.wheel}.load"] = tyre.wrench(self.value, step)
            self.value.update({f"wheel_{tyre.wheel}.{n}": float(v) for n, v in zip(HUB, wrench, strict=True)})

    def memory(self) -> Any:
        return [tyre.states for tyre in self.tyres]

    def recall(self, memory: Any) -> None:
        for tyre, states in zip(self.tyres, memory, strict=True):
            tyre.states = states
