"""A manoeuvre by name, by file or by the folder of a recording."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.recordings.format import is_recording


def load_manoeuvre(manoeuvre: str) -> Manoeuvre:
    """Read a manoeuvre by name or path; a folder that holds a recording of the simulator is its last drive.

    Parameters
    ----------
    manoeuvre : str
        See `hosts.driving.manoeuvre_file.read_manoeuvre`.

    Raises
    ------
    HostError
        With the line and the reason.
    """
    if not is_recording(Path(manoeuvre)):
        return read_manoeuvre(manoeuvre)
    from hosts.recordings.last_drive import recorded_manoeuvre

    return recorded_manoeuvre(Path(manoeuvre))


def manoeuvre_of(fmu: SimulatedFmu, given: str | None, stop_time: float | None) -> Manoeuvre:
    """What an FMU is run through.

    Parameters
    ----------
    given : str, optional
        As `load_manoeuvre` takes it; without it inputs keep their start values.
    stop_time : float, optional
        s; by default that of the manoeuvre, else that of the FMU's default experiment, else 10 s.
    """
    if given is not None:
        manoeuvre = load_manoeuvre(given)
        return manoeuvre if stop_time is None else replace(manoeuvre, stop_time=stop_time)
    if stop_time is None:
        experiment = fmu.description.defaultExperiment
        stop_time = float(experiment.stopTime) if experiment is not None and experiment.stopTime else 10.0
    return Manoeuvre("run", np.zeros(0), {}, stop_time)
