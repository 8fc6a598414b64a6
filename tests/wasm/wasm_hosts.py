"""Hosts that drive an FMU by the same plan: the native library, wasmtime, Node and Chromium."""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from numpy.typing import NDArray

from benchmarks.shared.fmu_module import FmuModule
from benchmarks.shared.fmu_page import ChromiumPage, NotHereError, in_node, job_of, resources_of

JS = Path(__file__).parent / "js"
STATUSES = ("ok", "warning", "discard", "error", "fatal")


@dataclass(frozen=True)
class Plan:
    """What is set before the start and in each step, and the outputs that are read."""

    start: dict[str, float | int | str]
    """Values by name; a road file by its name in the folder roads."""
    inputs: list[str]
    steps: list[dict[str, Any]]
    """Each with `h`, the values of the `inputs`, and `save`, whether the state is kept."""
    outputs: list[str] = field(default_factory=list)
    """All of them where the list is empty."""


@dataclass
class HostResult:
    """Results of a host: outputs before the first and after each step, saved states, refused steps."""

    rows: NDArray[np.float64]
    states: list[bytes]
    refusals: list[tuple[int, str]]


class Fmu:
    """An FMU for `linux64` (or whatever runs here) and `wasm32`, with files that a host adds."""

    def __init__(self, path: Path, folder: Path, added: dict[str, bytes] | None = None) -> None:
        self.path, self.folder = path, Path(fmpy.extract(str(path), unzipdir=str(folder)))
        self.added = added or {}
        for name, data in self.added.items():
            file = self.folder / "resources" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(data)
        self.description = fmpy.read_model_description(str(path))
        self.kinds = {v.name: (v.type, v.valueReference) for v in self.description.modelVariables}
        self.wasm, resources = resources_of(path)
        self.resources = resources | self.added

    def outputs(self, plan: Plan) -> list[str]:
        return plan.outputs or [v.name for v in self.description.modelVariables if v.causality == "output"]

    def job(self, plan: Plan) -> dict[str, Any]:
        """What `drive.js` takes."""
        description = {"start": plan.start, "inputs": plan.inputs, "steps": plan.steps, "outputs": self.outputs(plan)}
        return job_of(self.path, description, self.added)


def _drive(slave: Any, fmu: Fmu, plan: Plan) -> HostResult:
    """Simulate an object that has the methods of FMPy's slave."""

    def write(names: list[str], values: list[Any]) -> None:
        for name, value in zip(names, values, strict=True):
            kind, reference = fmu.kinds[name]
            getattr(slave, f"set{kind}")([reference], [value])

    def row() -> list[float]:
        results = {}
        for kind, names in groups.items():
            if names:
                values = getattr(slave, f"get{kind}")([fmu.kinds[name][1] for name in names])
                results |= dict(zip(names, values, strict=True))
        return [float(results[name]) for name in outputs]

    outputs = fmu.outputs(plan)
    groups = {kind: [name for name in outputs if fmu.kinds[name][0] == kind] for kind in ("Real", "Integer")}
    slave.setupExperiment(startTime=0.0)
    write(list(plan.start), list(plan.start.values()))
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    driven, time, rows = HostResult(np.empty(0), [], []), 0.0, [row()]
    for k, step in enumerate(plan.steps):
        write(plan.inputs, step["inputs"])
        try:
            slave.doStep(time, step["h"])
            time += step["h"]
        except FMICallException as error:
            driven.refusals.append((k, STATUSES[error.status]))
        rows.append(row())
        if step.get("save"):
            state = slave.getFMUState()
            driven.states.append(bytes(slave.serializeFMUState(state)))
            slave.freeFMUState(state)
    driven.rows = np.array(rows)
    return driven


def native(fmu: Fmu, plan: Plan) -> HostResult:
    """The library of this machine, through FMPy."""
    callbacks = fmi2CallbackFunctions()
    callbacks.allocateMemory, callbacks.freeMemory = defaultCallbacks.allocateMemory, defaultCallbacks.freeMemory
    callbacks.logger = fmi2CallbackLoggerTYPE(lambda *arguments: None)
    slave = FMU2Slave(
        guid=fmu.description.guid,
        unzipDirectory=str(fmu.folder),
        modelIdentifier=fmu.description.coSimulation.modelIdentifier,
        instanceName="native",
    )
    slave.instantiate(callbacks=callbacks)
    try:
        return _drive(slave, fmu, plan)
    finally:
        slave.freeInstance()


def wasmtime(fmu: Fmu, plan: Plan) -> HostResult:
    """The module in wasmtime, called without the page's JavaScript."""
    return _drive(FmuModule(fmu.wasm, fmu.resources, fmu.description.guid), fmu, plan)


def node(fmu: Fmu, plan: Plan) -> HostResult:
    """The module in Node, through the page's `fmu.js`."""
    return decoded(run_in_node("node_drive.mjs", fmu.job(plan)), plan)


def run_in_node(script: str, job: dict[str, Any]) -> Any:
    """Result of a script of the folder js for a job, by Node."""
    try:
        return in_node(JS / script, job)
    except NotHereError as error:
        pytest.skip(str(error))


class Chromium:
    """The modules of the page in a browser without a window; one start for all drives; a context."""

    def __enter__(self) -> Chromium:
        try:
            self._page = ChromiumPage(JS)
        except NotHereError as error:
            pytest.skip(str(error))
        return self

    def __exit__(self, *of: object) -> None:
        self._page.__exit__(*of)

    def __call__(self, fmu: Fmu, plan: Plan) -> HostResult:
        code = "async (job) => (await import('/drive.js')).drive((await import('/fmu.js')).loadFmu, job)"
        return decoded(self.run(code, fmu.job(plan)), plan)

    def run(self, code: str, argument: Any = None) -> Any:
        """Value of a JavaScript function in the page."""
        return self._page.run(code, argument)


def decoded(encoded: dict[str, Any], plan: Plan) -> HostResult:
    """Results of `drive.js` as arrays and bytes."""
    rows = np.frombuffer(base64.b64decode(encoded["rows"]))
    states = [base64.b64decode(text) for text in encoded["states"]]
    refusals = [(k, status) for k, status, _ in encoded["refusals"]]
    return HostResult(rows.reshape(len(plan.steps) + 1, -1), states, refusals)


def assert_same(actual: HostResult, expected: HostResult, fmu: Fmu, plan: Plan) -> None:
    """Fails with the first value that differs."""
    assert actual.refusals == expected.refusals
    differ = actual.rows.view(np.int64) != expected.rows.view(np.int64)
    if differ.any():
        k, i = np.argwhere(differ)[0]
        name, values = fmu.outputs(plan)[i], (actual.rows[k, i], expected.rows[k, i])
        pytest.fail(f"{differ.sum()} values differ, first '{name}' after step {k}: {values[0]!r} and {values[1]!r}")
    assert actual.states == expected.states
