"""Simulations of an FMU by the C host of the project and by libcosim."""

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import fmpy
import numpy as np
from numpy.typing import NDArray

from tests.fmu.native import compile_host, guid_of, unpack


def by_c_host(
    fmu: Path, folder: Path, start: Mapping[str, object], outputs: Sequence[str], steps: int, step: float
) -> NDArray[np.float64]:
    """Outputs after each step by the C host, shape (steps, n).

    `folder`: for the program and the unpacked FMU; `start`: values set before initialisation; `step`: s.
    """
    program = compile_host(folder)
    unpacked = unpack(fmu, folder / "fmu")
    references = {v.name: v.valueReference for v in fmpy.read_model_description(str(fmu)).modelVariables}
    requested = [references[name] for name in outputs]
    library = next((unpacked / "binaries" / fmpy.platform).iterdir())
    command = [
        program,
        library,
        (unpacked / "resources").as_uri(),
        guid_of(unpacked),
        steps,
        step,
        min(requested),
        max(requested),
    ]
    options = [part for name, value in start.items() for part in ("--set", f"{name}={value}")]
    process = subprocess.run([*map(str, command), *options], capture_output=True, text=True, check=True)
    rows = np.array([[float.fromhex(word) for word in line.split()] for line in process.stdout.splitlines()])
    return rows[:, [1 + reference - min(requested) for reference in requested]]


def by_libcosim(
    fmu: Path,
    inputs: Mapping[str, float],
    outputs: Sequence[str],
    steps: int,
    step: float,
    start: Mapping[str, object] | None = None,
) -> NDArray[np.float64]:
    """Outputs after each step by libcosim, shape (steps, n).

    `inputs`: constant, set after initialisation; `start`: values set before initialisation; `step`: s.
    """
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    variables = {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}
    execution = CosimExecution.from_step_size(round(1e9 * step))
    index = execution.add_local_slave(CosimLocalSlave(str(fmu), "one"))
    for name, value in (start or {}).items():
        number = variables[name].valueReference
        if variables[name].type == "Real":
            execution.real_initial_value(index, number, float(str(value)))
        else:
            execution.integer_initial_value(index, number, int(float(str(value))))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    if inputs:
        manipulator = CosimManipulator.create_override()
        execution.add_manipulator(manipulator)
        manipulator.slave_real_values(index, [variables[n].valueReference for n in inputs], list(inputs.values()))
    requested, rows = [variables[n].valueReference for n in outputs], []
    for _ in range(steps):
        assert execution.step(1)
        rows.append(list(observer.last_real_values(index, requested)))
    return np.array(rows)
