"""Trajectory made from the records of a run."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mbs.results.accuracy import Accuracy
from mbs.results.omitted_sensors import OmittedSensors
from mbs.results.step_control import Control
from mbs.results.trajectory import Trajectory
from mbs.settings.settings import Settings
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.run_roads import run_roads
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System
from mbs.system.text import notices_before

Array = NDArray[np.float64]
NO_FORCE = 1e-6  # of the weight, as `ali3_no_force` has it


def recorded(
    simulation: SteppedSystem,
    t: Array,
    values: Array,
    settings: Settings,
    wall: float,
    record: PositionRecord,
    left_out: OmittedSensors | None,
    notices: Iterable[str] = (),
    accuracy: Accuracy | None = None,
    control: Control | None = None,
) -> Trajectory:
    """Of a run that ended in `simulation`: `values` (n, ns) at `t` (n,), and what else is known of it.

    `notices`: sentences beside those of the System; empty ones are none.
    """
    sensors = prepared(simulation.system)[1]["sensors"]
    return Trajectory(
        t,
        values,
        [s["name"] for s in sensors],
        [s["unit"] for s in sensors],
        simulation.report,
        settings,
        wall,
        accuracy,
        [*notices_of(simulation.system, t, values), *filter(None, [*notices, simulation.start_text])],
        simulation.branch_change,
        control,
        record.poses(t),
        record.drawing,
        run_roads(simulation.system, simulation.instance, simulation.road_paths),
        left_out,
    )


def notices_of(system: System, t: Array, values: Array) -> list[str]:
    """What a run reports besides its numbers: `notices_before`, and what sensors with a notice say of their columns,
    `values` (n, ns) at `t` (n,).
    """
    meta = prepared(system)[1]
    notices, sensors = notices_before(meta), meta["sensors"]
    for k, sensor in enumerate(sensors):
        none = NO_FORCE * np.abs(system.arrays["gravity_force"]).max() if sensor["unit"] == "N" else 0.0
        nonzero = np.flatnonzero(np.abs(values[:, k]) > none if "notice" in sensor else ())
        if len(nonzero):
            most = values[np.argmax(np.abs(values[:, k])), k]
            notices.append(
                f"{sensor['notice']}: '{sensor['name']}' is not 0 from t = {t[nonzero[0]]:g} s, "
                f"at most {most:g} {sensor['unit']}."
            )
    return notices
