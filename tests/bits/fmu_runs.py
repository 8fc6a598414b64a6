"""Simulations of all kinds of FMUs of both cars in every manoeuvre, by FMPy and by the command."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy.simulation import instantiate_fmu

from tests.bits import doors, tables
from tests.bits.store import Entry, entry_of

STARTS: dict[str, dict[str, float]] = {
    "double_lane_change": {"initial.speed": 20.0},
    "drop": {"initial.z": 0.5},
    "kerb_drop": {"initial.speed": 5.0, "road.kerb_x": 7.5, "road.kerb_height": 0.08},
    "launch_and_brake": {},
    "slalom": {"initial.speed": 15.0},
    "steady_cornering": {"initial.speed": 8.0},
    "step_steer_given_throttle": {"initial.speed": 22.22},
}
"""Start values of an FMU for the inputs of a manoeuvre."""
TUNED = {"front.spring.stiffness": 21000.0, "rear.tyre.grip": 0.8, "brakes.balance": 0.55, "road.friction": 0.7}
INPUTS = ("steering", "throttle", "brake", "hand_brake", "selector", "steering_wheel_angle_demand")
STEP = 0.01  # s


def car_runs(car: str, fmus: Path, scratch: Path) -> Iterator[tuple[str, Entry]]:
    """Results of the command in every manoeuvre, and of all kinds of FMUs with the same inputs."""
    inputs = {}
    for manoeuvre in STARTS:
        table = tables.of_csv(doors.drive(doors.fmu_file(car, "fmi2", fmus), manoeuvre, scratch / manoeuvre))
        inputs[manoeuvre] = _inputs(table)
        yield f"drive/{car}/{manoeuvre}", entry_of(table)
    for kind in doors.KINDS:
        for run, signals in _kind_runs(doors.fmu_file(car, kind, fmus), kind, inputs, scratch / kind):
            yield f"fmu/{car}/{kind}/{run}", entry_of(signals)


def _kind_runs(
    fmu: Path, kind: str, inputs: Mapping[str, np.ndarray], folder: Path
) -> Iterator[tuple[str, dict[str, Any]]]:
    fmpy.extract(str(fmu), str(folder))
    yield "description", tables.of_xml((folder / "modelDescription.xml").read_bytes())
    description = fmpy.read_model_description(str(folder))
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]

    def run(manoeuvre: str, start: Mapping[str, Any]) -> dict[str, Any]:
        table = inputs[manoeuvre]
        start_values = {name: table[name][0] for name in INPUTS} | STARTS[manoeuvre] | dict(start)
        result = fmpy.simulate_fmu(
            str(folder),
            model_description=description,
            start_values=start_values,
            input=table,
            output=outputs,
            output_interval=STEP,
            stop_time=table["time"][-1],
            logger=lambda *words: None,
        )
        return _scalars(result)

    for manoeuvre in STARTS:
        yield manoeuvre, run(manoeuvre, {})
    for fidelity in (1, 2, 3):
        yield f"kerb_drop_{fidelity}", run("kerb_drop", {"fidelity": fidelity})
    yield "step_steer_given_throttle_tuned", run("step_steer_given_throttle", TUNED)
    for road in ("rough", "split", "washboard"):
        yield road, run("launch_and_brake", {"initial.speed": 12.0, "road.file": f"{road}.road"})
    if kind != "python":
        yield "derivatives", _derivatives(description, folder)


def _scalars(result: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of a result, with a column for each element of an array."""
    results = {}
    for name in result.dtype.names:
        shape = result[name].shape[1:]
        for index in np.ndindex(shape):
            results[name + "".join(f"[{k}]" for k in index)] = result[name][(slice(None), *index)]
    return results


def _inputs(table: Mapping[str, np.ndarray]) -> np.ndarray:
    """Input columns of a result as an array for FMPy, at multiples of the step."""
    values = np.zeros(len(table["time"]), [("time", float), *((name, float) for name in INPUTS)])
    values["selector"] = 1.0
    for name in values.dtype.names:
        if name in table:
            values[name] = table[name]
    return values


def _derivatives(description: Any, folder: Path) -> dict[str, Any]:
    """Directional derivatives of all outputs by the inputs in a turn with throttle."""
    variables = {v.name: v for v in description.modelVariables}
    outputs = [v for v in description.modelVariables if v.causality == "output" and v.type in ("Real", "Float64")]
    known = ("steering", "throttle")
    slave = instantiate_fmu(str(folder), description)
    first = description.fmiVersion == "2.0"
    write = slave.setReal if first else slave.setFloat64
    if first:
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
    else:
        slave.enterInitializationMode(startTime=0.0)
    write([variables["initial.speed"].valueReference], [12.0])
    slave.exitInitializationMode()
    references = [variables[name].valueReference for name in known]
    write(references, [0.1, 0.5])
    for k in range(40):
        slave.doStep(currentCommunicationPoint=k * STEP, communicationStepSize=STEP)
    results = {}
    for name, reference in zip(known, references, strict=True):
        for v in outputs:
            size = int(np.prod(v.shape)) if getattr(v, "shape", None) else 1
            if first:
                values = slave.getDirectionalDerivative([v.valueReference], [reference], [1.0])
            else:
                values = slave.getDirectionalDerivative([v.valueReference], [reference], [1.0], size)
            results[f"{v.name} by {name}"] = values
    slave.terminate()
    slave.freeInstance()
    return results
