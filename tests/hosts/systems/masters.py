"""Other people's programs that run an SSP: values of a part after equal steps."""

import ctypes
import sys
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from hosts.fmu.fmu import Fmu
from hosts.systems.ssp import SET

Master = Callable[[Path, Path, float, int, Sequence[str]], list[float]]
"""SSP, FMU of the part `car`, step s, count, outputs of it: their values then."""


def by_libcosim(ssp: Path, car: Path, step: float, count: int, names: Sequence[str]) -> list[float]:
    execution_of = pytest.importorskip("libcosimpy.CosimExecution").CosimExecution.from_ssp_file
    observer = pytest.importorskip("libcosimpy.CosimObserver").CosimObserver.create_last_value()
    folder = ssp.with_suffix("")
    with zipfile.ZipFile(ssp) as archive:
        archive.extractall(folder)
    execution = execution_of(str(folder), round(1e9 * step))
    execution.add_observer(observer)
    assert execution.step(count)
    with Fmu(car) as fmu:
        places = [fmu.variables[name].valueReference for name in names]
    values: list[float] = observer.last_real_values(execution.slave_index_from_instance_name("car"), places)
    return list(values)


def by_ecos(ssp: Path, car: Path, step: float, count: int, names: Sequence[str]) -> list[float]:
    library = Path(sys.prefix) / "lib" / "libtbb.so.12"
    if library.is_file():  # of the package tbb, which Ecos' own package needs and does not ask for
        ctypes.CDLL(str(library), ctypes.RTLD_GLOBAL)
    simulation = pytest.importorskip("ecospy", exc_type=OSError).EcosSimulation
    with simulation(step, ssp_path=str(ssp)) as run:
        assert run.init(parameter_set=SET)
        run.step(count)
        return [run.get_real(f"car::{name}") for name in names]


MASTERS: dict[str, Master] = {"libcosim": by_libcosim, "Ecos": by_ecos}
