"""Trajectory of the record of a run."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from mbs.elements.road import KerbRoad, PlaneRoad, Road
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ParameterTarget, RoadType
from mbs.results.accuracy import Accuracy
from mbs.results.omitted_sensors import OmittedSensors
from mbs.results.step_control import Control
from mbs.results.trajectory import Trajectory
from mbs.settings.settings import Settings
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System
from mbs.system.text import model_notices

Array = NDArray[np.float64]
NO_FORCE = 1e-6  # of the weight: force below which it counts as zero, as in `ali3_no_force`


def recorded_trajectory(
    simulation: SteppedSystem,
    t: Array,
    values: Array,
    settings: Settings,
    wall: float,
    record: PositionRecord,
    omitted: OmittedSensors | None,
    notices: Iterable[str] = (),
    accuracy: Accuracy | None = None,
    control: Control | None = None,
) -> Trajectory:
    """Trajectory of a run that ended in `simulation`: `values` (n, ns) at the times `t` (n,), s.

    `wall`: time in the kernel, s; `omitted`: sensors that were not computed; `notices`: sentences that are added to the
    System's; empty ones are dropped.
    """
    sensors = prepared(simulation.system).meta["sensors"]
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
        changed_roads(simulation.system, simulation.instance, simulation.road_paths),
        omitted,
    )


def notices_of(system: System, t: Array, values: Array) -> list[str]:
    """Notices of a run: the System's, and notices of sensors that must be zero and are not.

    `values` (n, ns): samples at the times `t` (n,), s.
    """
    meta = prepared(system).meta
    notices, sensors = model_notices(meta), meta["sensors"]
    for k, sensor in enumerate(sensors):
        threshold = NO_FORCE * np.abs(system.arrays["gravity_force"]).max() if sensor["unit"] == "N" else 0.0
        nonzero = np.flatnonzero(np.abs(values[:, k]) > threshold if "notice" in sensor else ())
        if len(nonzero):
            peak = values[np.argmax(np.abs(values[:, k])), k]
            notices.append(
                f"{sensor['notice']}: '{sensor['name']}' is not 0 from t = {t[nonzero[0]]:g} s, "
                f"at most {peak:g} {sensor['unit']}."
            )
    return notices


def changed_roads(system: System, instance: Instance, files: Mapping[int, str]) -> dict[int, Road | str]:
    """Changed roads by their numbers; a road file as its path.

    `instance`: has the values of the parameters; `files`: paths of road files by the number of the road they replace,
    an empty path for none.
    """
    arrays = system.arrays
    roads: dict[int, Road | str] = {k: path for k, path in files.items() if path}
    if not len(arrays["road_type"]):
        return roads
    real = np.array(arrays["road_parameter"])
    values = [instance.get_parameter(k) for k in range(len(arrays["par_value"]))]
    for k in np.flatnonzero(np.array(values) != arrays["par_value"]):
        for n in range(arrays["par_ptr"][k], arrays["par_ptr"][k + 1]):
            if arrays["par_target"][n] == ParameterTarget.ROAD:
                offset = arrays["par_offset"][n] if len(arrays["par_offset"]) else 0.0
                real[arrays["par_index"][n]] = values[k] * arrays["par_scale"][n] + offset
    for road, kind in enumerate(arrays["road_type"]):
        reals = slice(arrays["road_parameter_ptr"][road], arrays["road_parameter_ptr"][road + 1])
        if road in roads or np.array_equal(real[reals], arrays["road_parameter"][reals]):
            continue
        numbers = real[reals].tolist()
        if kind == RoadType.PLANE:
            roads[road] = PlaneRoad(*numbers)
        elif kind == RoadType.KERB:
            position, lower, step, side, *rest = numbers
            roads[road] = KerbRoad(position, step, lower, "before" if side > 0.0 else "after", *rest)
    return roads
