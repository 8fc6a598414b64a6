"""An FMU in libcosim."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import fmpy


def by_libcosim(fmu: Path, inputs: Mapping[str, float], outputs: Sequence[str], steps: int, step: float) -> list[float]:
    """Outputs after steps with inputs that are set after initialisation. `step`: s."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    references = {v.name: v.valueReference for v in fmpy.read_model_description(str(fmu)).modelVariables}
    execution = CosimExecution.from_step_size(round(1e9 * step))
    index = execution.add_local_slave(CosimLocalSlave(str(fmu), "one"))
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    manipulator.slave_real_values(index, [references[n] for n in inputs], list(inputs.values()))
    assert execution.step(steps)
    return list(observer.last_real_values(index, [references[n] for n in outputs]))
