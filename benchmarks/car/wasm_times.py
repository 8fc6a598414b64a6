"""Times of the steps of the car's FMU in the hosts that there are: native, wasmtime, Node, Chromium."""

from __future__ import annotations

import importlib.metadata
import struct
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import fmi2Real, fmi2ValueReference
from fmpy.simulation import instantiate_fmu

from benchmarks.shared.fmu_module import FmuModule
from benchmarks.shared.fmu_page import ChromiumPage, NotHereError, in_node, job_of, resources_of

KINDS = {"inner": "inner step, ten a call", "each": "one a call, inputs set, outputs read"}
Measure = Callable[[Mapping[str, Any]], dict[str, Any]]
_JS = Path(__file__).parents[1] / "shared" / "js"
_CLOCK = "async (job) => (await import('/clock.js')).clock((await import('/fmu.js')).loadFmu, job)"


def open_hosts(fmu: Path, folder: Path, stack: ExitStack) -> tuple[dict[str, Measure], dict[str, str]]:
    """The hosts by name, and their versions; what is not installed is said and left out.

    `fmu`: with the libraries of this machine and of wasm32; `stack`: closes what has to be closed. Returns `hosts`:
    functions that take a plan as `clock.js` does and return what it returns.
    """
    fmpy.extract(str(fmu), unzipdir=str(folder))
    versions = {"native": "zig cc -O3, baseline of the processor family (x86-64: SSE2)"}
    versions["wasmtime"] = importlib.metadata.version("wasmtime")
    hosts: dict[str, Measure] = {"native": _native(fmu, folder), "wasmtime": _wasmtime(fmu)}
    outputs = _outputs(fmu)
    try:
        versions["Node"] = in_node(_JS / "version.mjs", {})
        hosts["Node"] = lambda plan: in_node(_JS / "node_clock.mjs", job_of(fmu, {**plan, "outputs": outputs}))
        chromium = stack.enter_context(ChromiumPage(_JS))
        versions["Chromium"] = chromium.version
        hosts["Chromium"] = lambda plan: chromium.run(_CLOCK, job_of(fmu, {**plan, "outputs": outputs}))
    except NotHereError as error:
        print(f"left out: {error}", file=sys.stderr)
    return hosts, versions


def _variables(fmu: Path) -> dict[str, Any]:
    return {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}


def _outputs(fmu: Path) -> list[str]:
    """Real outputs."""
    return [v.name for v in _variables(fmu).values() if v.causality == "output" and v.type == "Real"]


def _timed(plan: Mapping[str, Any], start: Callable[[], None], works: Mapping[str, Callable[[], None]]) -> Any:
    """As in `clock.js`."""
    found: dict[str, Any] = {}
    for kind, work in works.items():
        found[kind] = []
        for run in range(plan["warmUp"] + plan["repeats"]):
            start()
            begin = time.perf_counter()
            work()
            if run >= plan["warmUp"]:
                found[kind].append(1e6 * (time.perf_counter() - begin) / plan["steps"])
    return found


def _measure(
    plan: Mapping[str, Any],
    start: Callable[[], None],
    step: Callable[[float, float], object],
    write: Callable[[], object],
    read: Callable[[], object],
) -> dict[str, Any]:
    h, inner, steps = plan["h"], plan["inner"], plan["steps"]

    def begin() -> None:
        start()
        write()

    def many() -> None:
        for k in range(0, steps, inner):
            step(k * h, inner * h)

    def each() -> None:
        for k in range(steps):
            write()
            step(k * h, h)
            read()

    return dict(_timed(plan, begin, {"inner": many, "each": each}))


def _native(fmu: Path, folder: Path) -> Measure:
    variables, outputs = _variables(fmu), _outputs(fmu)
    slave = instantiate_fmu(str(folder), fmpy.read_model_description(str(fmu)))
    references = (fmi2ValueReference * len(outputs))(*(variables[n].valueReference for n in outputs))
    values = (fmi2Real * len(outputs))()

    def measure(plan: Mapping[str, Any]) -> dict[str, Any]:
        given = [variables[n].valueReference for n in plan["inputs"]]
        known, put = (fmi2ValueReference * len(given))(*given), (fmi2Real * len(given))(*plan["values"])
        c = slave.component

        def start() -> None:
            slave.reset()
            for name, value in plan["start"].items():
                getattr(slave, f"set{variables[name].type}")([variables[name].valueReference], [value])
            slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
            slave.exitInitializationMode()

        found = _measure(
            plan,
            start,
            lambda t, h: slave.fmi2DoStep(c, t, h, 1),
            lambda: slave.fmi2SetReal(c, known, len(given), put),
            lambda: slave.fmi2GetReal(c, references, len(outputs), values),
        )
        return found | {"end": values[0]}

    return measure


def _wasmtime(fmu: Path) -> Measure:
    variables, outputs = _variables(fmu), _outputs(fmu)
    wasm, resources = resources_of(fmu)
    module = FmuModule(wasm, resources, fmpy.read_model_description(str(fmu)).guid)
    do_step, set_real, get_real = (module.caller(f"fmi2{name}") for name in ("DoStep", "SetReal", "GetReal"))
    wanted = [variables[n].valueReference for n in outputs]
    references, values = module.block(struct.pack(f"<{len(wanted)}I", *wanted)), module.block(bytes(8 * len(wanted)))

    def measure(plan: Mapping[str, Any]) -> dict[str, Any]:
        given = [variables[n].valueReference for n in plan["inputs"]]
        known = module.block(struct.pack(f"<{len(given)}I", *given))
        put = module.block(struct.pack(f"<{len(given)}d", *plan["values"]))

        def start() -> None:
            module.reset()
            for name, value in plan["start"].items():
                module.set(variables[name].type, [variables[name].valueReference], [value])
            module.setupExperiment()
            module.enterInitializationMode()
            module.exitInitializationMode()

        found = _measure(
            plan,
            start,
            lambda t, h: do_step(t, h, 1),
            lambda: set_real(known, len(given), put),
            lambda: get_real(references, len(outputs), values),
        )
        return found | {"end": struct.unpack("<d", module.bytes_at(values, 8))[0]}

    return measure
