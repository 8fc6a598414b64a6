"""Reference results in the layered standard fmi-ls-ref, with which an importer can check itself.

Manifest: modelica/fmi-ls-ref, 1.0.0-alpha.1; experiments: the draft of modelica/ma-hs-experiments.
"""

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

import numpy as np

from ali3.parameter_set import ParameterSet
from ali3.write_parameter_set import parameter_set_bytes
from fmu_src.description.description import number, to_bytes
from fmu_src.description.layered_standards import manifest
from fmu_src.native.reference_runs import Column, ReferenceRun

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
EXPERIMENTS = "experiments.exp"


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

    _add_related(references, EXPERIMENTS, "application/x-ma-hs-experiments", "experiment/smoke-test", "The experiments")
    given_parameters = f"{name}.ssv" if parameters.entries else ""
    if given_parameters:
        kind, words = "application/x-ssp-parameter-set", "All parameters with their defaults"
        _add_related(references, given_parameters, kind, "parameter", words)
        files[f"{FOLDER}/{given_parameters}"] = parameter_set_bytes(parameters, as_built=True)
    times = {"startTime": "0.0", "stopTime": number(stop_time), "stepSize": number(step)}
    for run in runs:
        experiment = ElementTree.SubElement(experiments, "Experiment")
        ElementTree.SubElement(experiment, "TransientSimulation", times)
        if given_parameters:
            ElementTree.SubElement(experiment, "Parameters", source=given_parameters)
        files |= _add_tables(experiment, references, run, name)
    return {
        f"{FOLDER}/fmi-ls-manifest.xml": to_bytes(references),
        f"{FOLDER}/{EXPERIMENTS}": to_bytes(experiments),
        **files,
    }


def _add_tables(
    experiment: ElementTree.Element, references: ElementTree.Element, run: ReferenceRun, name: str
) -> dict[str, bytes]:
    """Describe an experiment in both documents; its tables by path in the FMU."""
    label, words = ("in_turn", "each input in turn") if run.inputs else ("default", "no input touched")
    experiment.attrib.update(name=label, description=f"Default experiment, {words}")
    files = {}
    if run.inputs:
        inputs_file = f"{name}_{label}_in.csv"
        ElementTree.SubElement(experiment, "Stimuli", source=inputs_file)
        # the standard has no role for inputs
        _add_related(references, inputs_file, "text/csv", "other", "Inputs, straight between rows, held over each step")
        files[f"{FOLDER}/{inputs_file}"] = _csv(run.corners, run.inputs)
    source = f"{name}_{label}_out.csv" if run.inputs else f"{name}_out.csv"
    ElementTree.SubElement(experiment, "References", source=source)
    _add_related(references, source, "text/csv", "result", f"Outputs of the default experiment, {words}")
    files[f"{FOLDER}/{source}"] = _csv(run.t, run.columns)
    return files


def _add_related(references: ElementTree.Element, source: str, kind: str, role: str, words: str) -> None:
    ElementTree.SubElement(references, "Related", source=source, type=kind, role=role, description=words)


def _csv(t: Column, columns: Mapping[str, Column]) -> bytes:
    head = ",".join(['"time"', *(f'"{column}"' for column in columns)])
    rows = np.column_stack([t, *columns.values()])
    return ("\n".join([head, *(",".join(number(v) for v in row) for row in rows)]) + "\n").encode()
