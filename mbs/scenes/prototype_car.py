"""The prototype car of the paper (sections 3.4 and 4), rigid or with a flexible chassis: steering, throttle, brake."""

from collections.abc import Callable

from mbs.elements.road import Road
from mbs.model.model import Model
from mbs.model.records import DrivingFunction
from mbs.vehicle import Car, Fidelity, load


def car() -> Car:
    """Load the car from its file."""
    return load("prototype")


def build(
    road: Road | None = None,
    fidelity: Fidelity | int | str = Fidelity.RIGID,
    guide: Callable[[Model], DrivingFunction] | None = None,
) -> Model:
    """The car at rest in static equilibrium, its front axle over the origin; see `mbs.vehicle.Car.model`.

    Parameters
    ----------
    road : Road, optional
        By default level ground with a kerb far away.
    fidelity : Fidelity, int or str
        How much of the chassis is modelled, a member of `Fidelity`, its number or its name: 0 "rigid", 1
        "quasi_static", 2 "load_paths", 3 "dynamic", and for comparison 4 "many_modes" and "paper".
    guide : callable, optional
        Makes the driving function of the x coordinate of the floor's centre, m; the selector is then in neutral.
    """
    return car().model(road, fidelity, guide)


def fidelities() -> dict[Fidelity, Callable[[], Model]]:
    """Builders of the models that an FMU offers by its parameter `fidelity`."""
    return car().fidelities()


__all__ = ["Fidelity", "build", "car", "fidelities"]
