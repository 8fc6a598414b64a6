"""Metadata of a System: names, units, descriptions and reports."""

import math
from dataclasses import asdict
from typing import Any

from mbs.common.checks import flag, positive
from mbs.compiler.polynomial import RowTerms
from mbs.kernel.header.enumerations import ParameterTarget
from mbs.model.model import Model
from mbs.model.records import Input, Parameter
from mbs.model.sensor import Sensor


def _built_in_road(model: Model, parameter: Parameter) -> dict[str, int]:
    """The road whose built-in shape a parameter sets, which has no effect on a road from a file; empty if none."""
    roads = {road for family, road, *_ in parameter.targets if family == ParameterTarget.ROAD}
    other_targets = any(
        family != ParameterTarget.ROAD or model.roads[owner].real_names[real] == "friction_factor"
        for family, owner, real, *_ in parameter.targets
    )
    files = {f.road for f in model.road_files}
    return {"road": roads.pop()} if len(roads) == 1 and not other_targets and roads <= files else {}


def metadata(
    model: Model,
    coordinates: list[str],
    rows: list[RowTerms],
    report: dict[str, Any],
    lengths: list[float],
) -> dict[str, Any]:
    """Metadata of a System, for Python only.

    `coordinates`: their names; `lengths`: m, that one unit of each corresponds to.
    """
    return {
        "name": model.name,
        "dimension": model.dimension,
        "coordinates": coordinates,
        "rows": [{"name": r.name, "kind": r.kind} for r in rows],
        "inputs": [_input_entry(i) for i in model.inputs],
        "sensors": [_sensor_entry(s) for s in model.sensors],
        "parameters": [_parameter_entry(model, p) for p in model.parameters],
        "road_files": [
            {"name": f.name, "road": f.road, "start": f.start, "description": f.description} for f in model.road_files
        ],
        "constants": [
            {"name": c.name, "unit": c.unit, "description": c.description, "value": c.value} for c in model.constants
        ],
        **({"ahead": [asdict(a) for a in model.ahead]} if model.ahead else {}),
        "elements": [
            {
                "name": e.name,
                "type": e.type.name,
                "outputs": [{"name": o.name, "unit": o.unit, "description": o.description} for o in e.outputs],
            }
            for e in model.elements
        ],
        "switches": [{"name": s.name} for s in model.switches],
        "guides": [g.name for g in model.guides],
        "report": report,
        "experiment": {
            "stop_time_s": positive(model.stop_time, f"The stop_time of model '{model.name}'"),
            "step_s": positive(model.step, f"The step of model '{model.name}'"),
        },
        "floating": flag(model.floating, f"The floating of model '{model.name}'"),
        "gravity": math.hypot(*model.gravity),
        "coordinate_lengths": lengths,
    }


def _input_entry(i: Input) -> dict[str, Any]:
    """Entry of an input; what is usual is left out."""
    return (
        {
            "name": i.name,
            "unit": i.unit,
            "description": i.description,
            "start": i.start,
            "min": i.min if math.isfinite(i.min) else None,
            "max": i.max if math.isfinite(i.max) else None,
        }
        | ({"whole": True} if i.whole else {})
        | ({"port": True} if i.port else {})
        | ({"role": int(i.role)} if i.role else {})
        | ({"tried": i.tried} if i.tried is not None else {})
        | ({"near": i.near} if i.near else {})
        | ({"figures": list(i.figures)} if i.figures else {})
    )


def _sensor_entry(s: Sensor) -> dict[str, Any]:
    """Entry of a sensor; what is usual is left out."""
    return (
        {"name": s.name, "unit": s.unit, "description": s.description}
        | ({"whole": True} if s.whole else {})
        | ({"display_unit": s.display_unit} if s.display_unit else {})
        | ({"notice": s.notice} if s.notice else {})
        | ({} if s.computed else {"computed": False})
    )


def _parameter_entry(model: Model, p: Parameter) -> dict[str, Any]:
    """Entry of a parameter; what is usual is left out."""
    return (
        {"name": p.name, "unit": p.unit, "description": p.description, "value": p.value, "min": p.min, "max": p.max}
        | ({} if p.tunable else {"fixed": True})
        | ({} if p.works is None else {"works": list(p.works)})
        | ({"whole": True} if p.whole else {})
        | _built_in_road(model, p)
    )
