"""A car whose FMU takes the process with it, and one whose test has a fault."""

import os
import signal
from typing import Any

from tests.hosts.catalogue.bicycle_car import BicycleCar


class CrashingCar(BicycleCar):
    """It ends its process at the first drive."""

    def drive(self, *_: Any, **__: Any) -> Any:
        """See `TestedCar.drive`."""
        os.kill(os.getpid(), signal.SIGKILL)


class FaultyCar(BicycleCar):
    """It fails as only a program error does."""

    def drive(self, *_: Any, **__: Any) -> Any:
        """See `TestedCar.drive`."""
        return {}["nothing"]
