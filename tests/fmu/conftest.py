"""FMUs of small scenes, a bare host that reports statuses, and a process of its own for every test that loads one."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Callable, Collection
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

from fmu_src.build.build import FmuBuilder
from fmu_src.build.scene_registry import load_fidelities
from fmu_src.native.platforms import PYTHON_PLATFORMS, this_platform
from hosts.fmu.fmu import unpack
from tests import kinds
from tests.fmu.calls import OK, Slave3
from tests.forked import forked

SCENES = Path(__file__).parent / "scenes.py"
PLATFORM = fmpy.platform
DO_STEP_STATUS, LAST_SUCCESSFUL_TIME, TERMINATED = 0, 2, 3  # fmi2StatusKind
SOLVER = (
    *("solver.status", "solver.halvings", "solver.energy_error", "solver.energy_balance"),
    *("solver.capped_steps", "solver.capped_residual"),
)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """Native code and an interpreter inside the interpreter: a crash must fail one test, not the run."""
    if not hasattr(os, "fork"):
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}

    def call() -> str:
        pyfuncitem.obj(**arguments)
        return ""

    text, code = forked(call)
    if code:
        pytest.fail(text or f"the process that ran the FMU ended with {code}", pytrace=False)
    return True


@pytest.fixture(scope="session")
def need() -> Callable[[str], None]:
    """Skips a test where a kind of FMU cannot run."""

    def check(kind: str) -> None:
        if kind == "python" and this_platform() not in PYTHON_PLATFORMS:
            pytest.skip("PythonFMU ships libraries for x86-64 Linux and Windows only")

    return check


@pytest.fixture(scope="session")
def build(scene_fmu: Callable[..., Path], need: Callable[[str], None]) -> Callable[..., Path]:
    """Builds the FMU of a function of `scenes.py` once."""

    def make(scene: str, kind: str = "native") -> Path:
        need(kind)
        return scene_fmu(f"{SCENES}:{scene}", kind)

    return make


@pytest.fixture(scope="session")
def kerb_fmus(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Path:
    """A folder with both versions of the FMU of the paper's test, a car with a flexible frame in four fidelities."""

    def fill(folder: Path) -> None:
        name, systems, default = load_fidelities("kerb_test")
        builder = FmuBuilder(systems, name, default, ("", "", ""), lambda what, note="": nullcontext())
        for kind in kinds.VERSIONS:
            builder.build(kind, [PLATFORM], folder / f"{kind}.fmu")

    return made_once("kerb_test", fill)


@pytest.fixture(params=kinds.FACES)
def kind(request: pytest.FixtureRequest) -> str:
    """For what both versions of FMI pass to the slave in C; `test_one_slave.py` holds the kind in Python against it."""
    return str(request.param)


@pytest.fixture
def crane(build: Callable[..., Path], kind: str) -> Path:
    """A rod on a hinge with a motor, a spring and a parameter."""
    return build("crane", kind)


@pytest.fixture
def reach(build: Callable[..., Path], kind: str) -> Path:
    """A mechanism that an input can pull beyond its reach."""
    return build("reach", kind)


@pytest.fixture
def sled(build: Callable[..., Path], kind: str) -> Path:
    """A body that is not tied to the ground."""
    return build("sled", kind)


class Host:
    """The calls of FMI by name; each gives its status."""

    def __init__(self, path: Path, folder: Path | None = None, guid: str | None = None) -> None:
        self.description = fmpy.read_model_description(str(path))
        self.three = self.description.fmiVersion.startswith("3")
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.folder = folder or Path(tempfile.mkdtemp(prefix="fmu_"))
        unpack(path, self.folder)
        self.messages: list[str] = []
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.allocateMemory = defaultCallbacks.allocateMemory
        self._callbacks.freeMemory = defaultCallbacks.freeMemory
        self._callbacks.logger = fmi2CallbackLoggerTYPE(lambda e, n, s, c, text: self.messages.append(text.decode()))
        self.slave = self.instance(guid)

    def instance(self, guid: str | None = None, name: str = "test", *, logged: bool = False) -> Any:
        arguments = {
            "guid": guid or self.description.guid,
            "unzipDirectory": str(self.folder),
            "modelIdentifier": self.description.coSimulation.modelIdentifier,
            "instanceName": name,
        }
        if self.three:
            sizes = {v.valueReference: math.prod(v.shape or (1,)) for v in self.description.modelVariables}
            slave = Slave3(sizes, **arguments)
            slave.instantiate(logMessage=lambda *a: self.messages.append(a[-1].decode()), loggingOn=logged)
        else:
            slave = FMU2Slave(**arguments)
            slave.instantiate(callbacks=self._callbacks, loggingOn=logged)
        return slave

    def wishes_end(self) -> bool:
        """Whether the last step wished the end; in FMI 2.0 what came after it may have taken that back."""
        return bool(self.slave.end if self.three else self.slave.getBooleanStatus(TERMINATED))

    def step_status(self) -> int:
        """Status of the last step."""
        return int(self.slave.status if self.three else self.slave.getStatus(DO_STEP_STATUS))

    def last_time(self) -> float:
        """Last successful time, s."""
        return float(self.slave.last if self.three else self.slave.getRealStatus(LAST_SUCCESSFUL_TIME))

    def whole_status(self, time: float, step: float) -> int:
        """Status of a step, also a warning, which FMPy hides."""
        if self.three:
            self.call("doStep", time, step)
            return int(self.slave.status)
        return int(self.slave.dll.fmi2DoStep(self.slave.component, time, step, 1))

    def free(self, slave: Any) -> None:
        """Free an instance; its library stays."""
        (slave.fmi3FreeInstance if self.three else slave.fmi2FreeInstance)(slave.component)

    def call(self, function: str, *arguments: Any) -> int:
        """Status of a method of FMPy's slave."""
        try:
            getattr(self.slave, function)(*arguments)
        except FMICallException as error:
            return int(error.status)
        return OK

    def start(self, values: dict[str, float] | None = None, time: float = 0.0) -> Host:
        self.slave.setupExperiment(startTime=time)
        for name, value in (values or {}).items():
            assert self.set(name, value) == OK
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        return self

    def set(self, name: str, value: float) -> int:
        return self.call("setReal", [self.references[name]], [value])

    def saved(self) -> bytes:
        """The state as bytes."""
        return bytes(self.slave.serializeFMUstate(self.slave.getFMUstate()))

    def restore(self, data: bytes) -> int:
        """Status of setting a serialised state, whichever of the two calls refuses it."""
        try:
            state = self.slave.deSerializeFMUstate(data)
        except FMICallException as error:
            return int(error.status)
        return self.call("setFMUstate", state)

    def get(self, name: str) -> float:
        return float(self.slave.getReal([self.references[name]])[0])

    def outputs(self) -> list[float]:
        """Those that are sensors of the scene, whole ones as real numbers; the solver's figures come after."""
        names = [v.name for v in self.description.modelVariables if v.causality == "output"]
        while names[-1] in SOLVER:
            names.pop()
        return list(self.slave.getReal([self.references[n] for n in names]))

    def everything(self, but: Collection[str] = ()) -> list[float]:
        """All variables but those named, the solver's figures too."""
        return list(self.slave.getReal([r for name, r in self.references.items() if name not in but]))

    def step(self, time: float, step: float) -> int:
        return self.call("doStep", time, step)

    def run(self, steps: int, step: float, time: float = 0.0) -> list[list[float]]:
        rows = []
        for k in range(steps):
            assert self.step(time + k * step, step) == OK
            rows.append(self.outputs())
        return rows


@pytest.fixture
def host() -> Callable[..., Host]:
    """Makes hosts."""
    return Host
