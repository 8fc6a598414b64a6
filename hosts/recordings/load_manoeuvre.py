"""The option ``--manoeuvre``: a manoeuvre by name, by file or by the folder of a recording, or none."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.recordings.format import is_recording
from hosts.recordings.last_drive import recorded_manoeuvre


def load_manoeuvre(manoeuvre: str, stop_time: float | None = None) -> Manoeuvre:
    """Read a manoeuvre by name or path; of the folder of a recording the last drive.

    `manoeuvre`: see `hosts.driving.manoeuvre_file.read_manoeuvre`; `stop_time`: in place of its own, s. Raises
    `HostError` with the line and the reason.
    """
    if not is_recording(Path(manoeuvre)):
        return read_manoeuvre(manoeuvre, stop_time)
    recorded = recorded_manoeuvre(Path(manoeuvre))
    return recorded if stop_time is None else replace(recorded, stop_time=stop_time)


def check_manoeuvre_option(manoeuvre: str | None) -> None:
    """Raise `HostError` if a manoeuvre cannot be read, before an FMU is built. `manoeuvre`: see `load_manoeuvre`."""
    if manoeuvre is not None and not is_recording(Path(manoeuvre)):
        read_manoeuvre(manoeuvre, stop_time=1.0)  # a table may leave the stop time to the option


def manoeuvre_of(fmu: SimulatedFmu, manoeuvre: str | None, stop_time: float | None) -> Manoeuvre:
    """The manoeuvre of a run.

    `manoeuvre`: see `load_manoeuvre`; without it inputs keep their start values; `stop_time`: in s; by default that of
    the manoeuvre, else that of the FMU's default experiment, else 10 s.
    """
    if manoeuvre is not None:
        return load_manoeuvre(manoeuvre, stop_time)
    if stop_time is None:
        experiment = fmu.description.defaultExperiment
        stop_time = float(experiment.stopTime) if experiment is not None and experiment.stopTime else 10.0
    return Manoeuvre("run", np.zeros(0), {}, stop_time)
