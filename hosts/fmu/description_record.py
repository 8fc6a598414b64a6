"""The content of `modelDescription.xml` as JSON for pages."""

from typing import Any

from fmpy.model_description import ModelDescription

from hosts.common.numbers import or_null
from hosts.fmu.variables import Variable, Variables


def description_record(description: ModelDescription, variables: Variables) -> dict[str, Any]:
    """The content of `modelDescription.xml` as JSON, as pages read it."""
    experiment = description.defaultExperiment
    settings = {name: getattr(experiment, name, None) for name in ("startTime", "stopTime", "stepSize")}
    references = {v.name: int(v.valueReference) for v in description.modelVariables}
    return {
        "modelName": description.modelName,
        "guid": description.guid,
        "description": description.description or "",
        **{key: float(value) for key, value in settings.items() if value is not None},
        "variables": [_variable(variables[name], references[name]) for name in variables.names],
    }


def _variable(v: Variable, reference: int) -> dict[str, Any]:
    record = {
        "name": v.name,
        "reference": reference,
        "type": "Integer" if v.kind == "Enumeration" else v.kind,
        "causality": v.causality,
        "variability": v.variability,
        "unit": v.unit,
        "start": v.start,
        "min": or_null(v.low),
        "max": or_null(v.high),
        "description": v.description,
        "items": v.items or None,
    }
    return {key: value for key, value in record.items() if value is not None}
