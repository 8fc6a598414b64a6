"""The option ``--manoeuvre``, and the run of an FMU without one."""

import numpy as np

from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.recordings.load_manoeuvre import load_manoeuvre


def manoeuvre_of(fmu: SimulatedFmu, manoeuvre: str | None, stop_time: float | None) -> Manoeuvre:
    """The manoeuvre of a run.

    `manoeuvre`: see `hosts.recordings.load_manoeuvre.load_manoeuvre`; without it inputs keep their start values;
    `stop_time`: in s; by default that of the manoeuvre, else that of the FMU's default experiment, else 10 s.
    """
    if manoeuvre is not None:
        return load_manoeuvre(manoeuvre, stop_time)
    if stop_time is None:
        experiment = fmu.description.defaultExperiment
        stop_time = float(experiment.stopTime) if experiment is not None and experiment.stopTime else 10.0
    return Manoeuvre("run", np.zeros(0), {}, stop_time)
