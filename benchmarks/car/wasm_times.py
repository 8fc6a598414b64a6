"""Time of a step of the car's FMU, native and as WebAssembly in wasmtime, Node and Chromium."""

import gzip
import importlib.metadata
import struct
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import fmpy
from fmpy.fmi2 import fmi2Real, fmi2ValueReference
from fmpy.simulation import instantiate_fmu

from benchmarks.shared.command import report_missing, watched
from benchmarks.shared.fmu_module import FmuModule
from benchmarks.shared.fmu_page import ChromiumPage, NotHereError, in_node, job_of, resources_of
from benchmarks.shared.pages import Row, crossed
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities

FIDELITIES = (0, 2)
INNER = 10
PLAN = {"inputs": ["steering", "throttle"], "values": [0.1, 0.3], "inner": INNER}
KINDS = {"inner": "inner step, ten a call", "each": "one a call, inputs set, outputs read"}
Measure = Callable[[Mapping[str, Any]], dict[str, Any]]
_JS = Path(__file__).parents[1] / "shared" / "js"
_CLOCK = "async (job) => (await import('/clock.js')).clock((await import('/fmu.js')).loadFmu, job)"


def open_hosts(fmu: Path, folder: Path, stack: ExitStack) -> tuple[dict[str, Measure], dict[str, str]]:
    """The installed hosts by name, and their versions; others are named on the error stream.

    `fmu`: FMU with the libraries of this machine and of wasm32; `stack`: closes the browser. A host is a function with
    the argument and result of `clock.js`.
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
        report_missing(str(error))
    return hosts, versions


def _variables(fmu: Path) -> dict[str, Any]:
    return {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}


def _outputs(fmu: Path) -> list[str]:
    """Names of the real outputs."""
    return [v.name for v in _variables(fmu).values() if v.causality == "output" and v.type == "Real"]


def _timed(plan: Mapping[str, Any], start: Callable[[], None], works: Mapping[str, Callable[[], None]]) -> Any:
    """Microseconds of an inner step in each repeat, by kind of call, as in `clock.js`."""
    results: dict[str, Any] = {}
    for kind, work in works.items():
        results[kind] = []
        for run in range(plan["warmUp"] + plan["repeats"]):
            start()
            begin = time.perf_counter()
            work()
            if run >= plan["warmUp"]:
                results[kind].append(1e6 * (time.perf_counter() - begin) / plan["steps"])
    return results


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
        inputs = [variables[n].valueReference for n in plan["inputs"]]
        input_references, input_values = (
            (fmi2ValueReference * len(inputs))(*inputs),
            (fmi2Real * len(inputs))(*plan["values"]),
        )
        c = slave.component

        def start() -> None:
            slave.reset()
            for name, value in plan["start"].items():
                getattr(slave, f"set{variables[name].type}")([variables[name].valueReference], [value])
            slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
            slave.exitInitializationMode()

        result = _measure(
            plan,
            start,
            lambda t, h: slave.fmi2DoStep(c, t, h, 1),
            lambda: slave.fmi2SetReal(c, input_references, len(inputs), input_values),
            lambda: slave.fmi2GetReal(c, references, len(outputs), values),
        )
        return result | {"end": values[0]}

    return measure


def _wasmtime(fmu: Path) -> Measure:
    variables, outputs = _variables(fmu), _outputs(fmu)
    wasm, resources = resources_of(fmu)
    module = FmuModule(wasm, resources, fmpy.read_model_description(str(fmu)).guid)
    do_step, set_real, get_real = (module.caller(f"fmi2{name}") for name in ("DoStep", "SetReal", "GetReal"))
    read = [variables[n].valueReference for n in outputs]
    references, values = module.block(struct.pack(f"<{len(read)}I", *read)), module.block(bytes(8 * len(read)))

    def measure(plan: Mapping[str, Any]) -> dict[str, Any]:
        inputs = [variables[n].valueReference for n in plan["inputs"]]
        input_references = module.block(struct.pack(f"<{len(inputs)}I", *inputs))
        input_values = module.block(struct.pack(f"<{len(inputs)}d", *plan["values"]))

        def start() -> None:
            module.reset()
            for name, value in plan["start"].items():
                module.set(variables[name].type, [variables[name].valueReference], [value])
            module.setupExperiment()
            module.enterInitializationMode()
            module.exitInitializationMode()

        result = _measure(
            plan,
            start,
            lambda t, h: do_step(t, h, 1),
            lambda: set_real(input_references, len(inputs), input_values),
            lambda: get_real(references, len(outputs), values),
        )
        return result | {"end": struct.unpack("<d", module.bytes_at(values, 8))[0]}

    return measure


def measure(steps: int, repeats: int, rounds: int) -> list[dict[str, Any]]:
    """Rows of every host, fidelity and kind of call. Raises `RuntimeError` if their results differ at the end."""
    name, systems, _ = load_fidelities("prototype_car")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, ExitStack() as stack:
        fmu = build_fmu(systems, name, folder, [fmpy.platform, "wasm32"], kind="native")
        h = float(fmpy.read_model_description(str(fmu)).defaultExperiment.stepSize)
        hosts, versions = open_hosts(fmu, Path(folder, "unpacked"), stack)
        results: dict[tuple[int, str, str], list[float]] = {}
        for fidelity in watched(FIDELITIES):
            total_steps = max(INNER, (steps if fidelity == 0 else steps // 2) // INNER * INNER)
            start = {"initial.speed": 15.0, "fidelity": fidelity}
            plan = {**PLAN, "h": h, "start": start, "steps": total_steps, "warmUp": 1, "repeats": repeats}
            ends = set()
            for _ in range(rounds):
                for host, timed in hosts.items():
                    times = timed(plan)
                    ends.add(times.pop("end"))
                    for kind, values in times.items():
                        results.setdefault((fidelity, kind, host), []).extend(values)
            if len(ends) != 1:
                raise RuntimeError(f"The hosts do not end at the same place: {sorted(ends)}.")
        wasm, _ = resources_of(fmu)
    print(f"module: {len(wasm) / 1e3:.0f} kB, {len(gzip.compress(wasm, 9, mtime=0)) / 1e3:.0f} kB gzipped")
    print("hosts: " + ", ".join(f"{host} {version}" for host, version in versions.items()))
    return [
        {"fidelity": str(fidelity), "what": KINDS[kind], "host": host, "best_us": min(values)}
        for (fidelity, kind, host), values in results.items()
    ]


def wasm_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Table of the least time of an inner step, us, by host."""
    return {"wasm": crossed(rows, _name, "host", lambda r: f"{r['best_us']:.0f}", "fidelity, calls")}


def _name(row: Row) -> str:
    return f"{row['fidelity']}, {row['what']}"
