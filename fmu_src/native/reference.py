"""Reference results in the layered standard fmi-ls-ref, with which an importer can check itself.

Manifest: modelica/fmi-ls-ref, 1.0.0-alpha.1; experiments: the draft of modelica/ma-hs-experiments.
"""

import contextlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

import mbs
from ali3.parameter_set import ParameterSet
from ali3.write_parameter_set import parameter_set_bytes
from fmu_src.description.description import number, to_bytes
from fmu_src.description.layered_standards import manifest
from fmu_src.variables.variables import Variable
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.simulation.refusal import refusal

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
EXPERIMENTS = "experiments.exp"
_ROWS = 100
_PART = 0.2
Column = NDArray[np.float64]


@dataclass(frozen=True)
class ReferenceRun:
    """An experiment."""

    t: Column
    """Shape (n,): times, s."""
    columns: dict[str, Column]
    """Each of shape (n,): outputs by name."""
    corners: Column = field(default_factory=lambda: np.zeros(0))
    """Shape (m,): times between which inputs go straight, s; empty: no input is touched."""
    inputs: dict[str, Column] = field(default_factory=dict)
    """Each of shape (m,): their values there."""


def reference_runs(system: mbs.System, follower: mbs.System | None = None) -> tuple[ReferenceRun, ...]:
    """The default experiment without inputs and, if it runs, with each input in turn; about a hundred rows each.

    An input goes a fifth of the way to the end of its range and back, and is held over each step.

    `follower`: System that computes what one with ports leaves out (`mbs.compiler.ports`). Raises `SimulationError` if
    the default experiment does not run; the sentence names what of the scene sets it.
    """
    experiment = system.meta["experiment"]
    step = float(experiment["step_s"])
    steps = max(1, round(float(experiment["stop_time_s"]) / step))
    try:
        runs = [_run(system, follower, steps, step, np.zeros(0), {})]
    except mbs.SimulationError as error:
        raise mbs.SimulationError(
            f"The default experiment, {steps * step:g} s in steps of {step:g} s as `m.stop_time` and `m.step` of the "
            f"scene say, does not run: {error}",
            error.time,
            error.status,
            error.trajectory,
        ) from None
    corners, inputs = _in_turn(system.meta["inputs"], steps * step)
    if inputs:
        untrusted = (mbs.SimulationError, mbs.AccuracyWarning)  # then it is not a reference
        with warnings.catch_warnings(), contextlib.suppress(*untrusted):
            warnings.simplefilter("error", mbs.AccuracyWarning)
            runs.append(_run(system, follower, steps, step, corners, inputs))
    return tuple(runs)


def _in_turn(entries: Sequence[Mapping[str, Any]], stop: float) -> tuple[Column, dict[str, Column]]:
    """Corners and values: real inputs with a range move one after the other, in the order of the table."""
    moving = []
    for entry in entries:
        start, limits = float(entry["start"]), [entry["max"], entry["min"]]  # None: open
        limits = [start + entry["tried"]] if "tried" in entry else limits
        end_value = next((float(end) for end in limits if end is not None and abs(end) < 1e300 and end != start), None)
        if end_value is not None and not entry.get("whole"):
            moving.append((str(entry["name"]), start, start + _PART * (end_value - start)))
    corners = np.linspace(0.0, stop, 2 * len(moving) + 1)
    inputs = {name: np.full(len(corners), start) for name, start, _ in moving}
    for k, (name, _, peak) in enumerate(moving):
        inputs[name][2 * k + 1] = peak
    return corners, inputs


def _run(
    system: mbs.System,
    follower: mbs.System | None,
    steps: int,
    step: float,
    corners: Column,
    inputs: Mapping[str, Column],
) -> ReferenceRun:
    simulation = mbs.Simulation(system)
    instance = simulation.instance
    follower_instance = None if follower is None else Instance(LoadedSystem(follower.kernel_bytes()))
    sensors = system.meta["sensors"]
    left_out = np.array([not entry.get("computed", True) for entry in sensors])
    names, step_times = [e["name"] for e in system.meta["inputs"]], np.arange(steps) * step
    step_values = {names.index(name): np.interp(step_times, corners, values) for name, values in inputs.items()}
    times, rows, row_interval = [], [], max(1, steps // _ROWS)
    for k in range(steps + 1):
        if k % row_interval == 0:
            simulation.step(step, 0)  # makes none; warns if the energy balance of the earlier ones is wrong
            row = np.array(instance.sensors())
            if follower_instance is not None:
                follower_instance.follow(instance)
                row = np.where(left_out, np.array(follower_instance.sensors()), row)
            times.append(simulation.time)
            rows.append(row)
        if k < steps:
            for index, values in step_values.items():
                instance.set_input(index, values[k])
            try:
                instance.step(step)
            except KernelError as error:
                failure = f"The step from t = {simulation.time:g} s with h = {step:g} s failed"
                raise refusal(simulation, failure, error) from None
    columns = {entry["name"]: column for entry, column in zip(sensors, np.array(rows).T, strict=True)}
    return ReferenceRun(np.array(times), columns, corners, dict(inputs))


def with_other_names(run: ReferenceRun, named: Mapping[str, Variable]) -> ReferenceRun:
    """The run with its columns and inputs as the FMU calls them, in its units; `named`: the variables by their names in
    the System.
    """

    def called(columns: Mapping[str, Column]) -> dict[str, Column]:
        return {named[key].name: column * named[key].scale for key, column in columns.items()}

    return replace(run, columns=called(run.columns), inputs=called(run.inputs))


def reference_files(
    name: str, runs: Sequence[ReferenceRun], stop_time: float, step: float, parameters: ParameterSet
) -> dict[str, bytes]:
    """Manifest, experiments, their parameters, inputs and results.

    `runs`: result of `reference_runs`; `stop_time`, `step`: default experiment, s; `parameters`: their values.
    Result: by path in the FMU.
    """
    references = manifest(
        "fmiReferences",
        name="org.fmi-standard.fmi-ls-ref",
        version="1.0.0-alpha.1",
        description="Layered Standard providing information on related files included in an FMU.",
    )
    experiments = ElementTree.Element("Experiments", name=f"Default experiment of {name}")
    files = {}

    def related(source: str, kind: str, role: str, words: str) -> None:
        ElementTree.SubElement(references, "Related", source=source, type=kind, role=role, description=words)

    related(EXPERIMENTS, "application/x-ma-hs-experiments", "experiment/smoke-test", "The experiments")
    given_parameters = f"{name}.ssv"
    if parameters.entries:
        related(given_parameters, "application/x-ssp-parameter-set", "parameter", "All parameters with their defaults")
        files[f"{FOLDER}/{given_parameters}"] = parameter_set_bytes(parameters, as_built=True)
    for run in runs:
        label, words = ("in_turn", "each input in turn") if run.inputs else ("default", "no input touched")
        experiment = ElementTree.SubElement(
            experiments, "Experiment", name=label, description=f"Default experiment, {words}"
        )
        times = {"startTime": "0.0", "stopTime": number(stop_time), "stepSize": number(step)}
        ElementTree.SubElement(experiment, "TransientSimulation", times)
        if parameters.entries:
            ElementTree.SubElement(experiment, "Parameters", source=given_parameters)
        source = f"{name}_out.csv" if label == "default" else f"{name}_{label}_out.csv"
        if run.inputs:
            inputs_file = f"{name}_{label}_in.csv"
            ElementTree.SubElement(experiment, "Stimuli", source=inputs_file)
            # the standard has no role for inputs
            related(inputs_file, "text/csv", "other", "Inputs, straight between rows, held over each step")
            files[f"{FOLDER}/{inputs_file}"] = _csv(run.corners, run.inputs)
        ElementTree.SubElement(experiment, "References", source=source)
        related(source, "text/csv", "result", f"Outputs of the default experiment, {words}")
        files[f"{FOLDER}/{source}"] = _csv(run.t, run.columns)
    return {
        f"{FOLDER}/fmi-ls-manifest.xml": to_bytes(references),
        f"{FOLDER}/{EXPERIMENTS}": to_bytes(experiments),
        **files,
    }


def _csv(t: Column, columns: Mapping[str, Column]) -> bytes:
    head = ",".join(['"time"', *(f'"{column}"' for column in columns)])
    rows = np.column_stack([t, *columns.values()])
    return ("\n".join([head, *(",".join(number(v) for v in row) for row in rows)]) + "\n").encode()
