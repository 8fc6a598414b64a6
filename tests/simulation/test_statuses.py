"""Each status of the kernel is provoked, in the kernel and through Python."""

import ctypes
import functools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchmarks.references.cases import system_of
from mbs import Model, Pose, Settings, Simulation, SimulationError, System, compile, simulate
from mbs.elements import PlaneRoad
from mbs.kernel.binding import KernelError, LoadedSystem, Status, load_library, loaded_system
from mbs.kernel.binding.errors import status_cause, status_remedy
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import Cause
from mbs.scenes import prototype_car
from tests.kernel.scenes import four_bar
from tests.kernel.system_builder import SystemBuilder
from tests.methods.test_refusals import driven_four_bar, four_bar_with_crank, sliding
from tests.model.table_models import number_model
from tests.model.test_free_wheels import WHEELS
from tests.model.test_parametric_inertias import DRAWN, thrown
from tests.simulation.test_start_in_equilibrium import hanging

Cause_ = Callable[[Path], object]


def started(builder: SystemBuilder) -> Instance:
    instance = Instance(LoadedSystem(builder.to_bytes()))
    instance.initialise()
    return instance


def without_memory(_: Path) -> None:
    """Memory of the caller's, of whom none is left."""
    allocate = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t)
    release = ctypes.CFUNCTYPE(None, ctypes.c_void_p)

    class Memory(ctypes.Structure):
        _fields_ = (("allocate", allocate), ("release", release))

    memory = Memory(allocate(lambda *_: None), release(lambda _: None))
    library = ctypes.CDLL(load_library()._name)
    library.ali3_status_text.restype = ctypes.c_char_p
    library.ali3_system_load = lambda data, size, *rest: library.ali3_system_load_with(
        data, ctypes.c_size_t(size), ctypes.byref(memory), *rest[:-1], ctypes.c_size_t(rest[-1])
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loaded_system, "load_library", lambda: library)
        LoadedSystem(four_bar().to_bytes())


def fixed(_: Path) -> None:
    instance = Instance(LoadedSystem(thrown(DRAWN, True).to_bytes()))
    instance.initialise()
    instance.set_parameter(0, 1.0)


def no_road(folder: Path) -> None:
    file = folder / "a.road"
    file.write_bytes(b"no road")
    Instance(LoadedSystem(car().to_bytes())).set_road(0, file)


@functools.cache
def car(road: PlaneRoad | None = None) -> System:
    return compile(prototype_car.build(road) if road else prototype_car.build())


KERNEL: dict[Status, Cause_] = {
    Status.BAD_ARGUMENT: lambda _: started(four_bar()).step(math.nan),
    Status.BAD_FILE: lambda _: LoadedSystem(b"no System"),
    Status.NO_MEMORY: without_memory,
    Status.NOT_INITIALISED: lambda _: Instance(LoadedSystem(four_bar().to_bytes())).step(0.01),
    Status.FIXED_PARAMETER: fixed,
    Status.BAD_ROAD: no_road,
}
"""What Python checks before, or has no way to ask for."""


def led_too_far(_: Path) -> None:
    """A crank that is asked for an angle at which its bars do not reach."""
    m, crank = four_bar_with_crank()
    turn = m.guide_input("angle", input=m.input("angle", min=-4.0, max=4.0, unit="rad"), frequency=5.0, unit="rad")
    m.drive("motor", m.relative_angle("turned", m.ground, crank), turn)
    Simulation(compile(m), inputs={"angle": 3.0})


def without_mass(_: Path) -> None:
    system = system_of("pendulum")
    Simulation(system.with_arrays({"mass_val": 0.0 * system.arrays["mass_val"]}))


def infinite(_: Path) -> None:
    m = Model("thrown", dimension=2)
    m.force("push", m.point_mass("ball", mass=1e-10, position=(0.0, 0.0)), inputs=[m.input("push", unit="N"), None])
    simulate(compile(m), 1.0, 0.02, {"push": lambda t: 0.0 if t < 0.1 else 1e300}, progress=False)


def beyond(_: Path) -> None:
    Simulation(compile(number_model(np.linspace(-0.2, 0.2, 9)))).step(0.001, 252)


def turning(_: Path) -> None:
    Simulation(compile(WHEELS["armature"](60.0).model), settings=Settings(max_halvings=0)).step(0.01, 100)


PYTHON: dict[Status, Cause_] = {
    Status.BAD_STATE: lambda _: Simulation(system_of("pendulum")).restore(b"no state"),
    Status.NOT_ASSEMBLED: led_too_far,
    Status.SINGULAR: without_mass,
    Status.NOT_CONVERGED: lambda _: Simulation(
        compile(driven_four_bar(5.0)), settings=Settings(max_iterations=1, max_halvings=0, method="energy_momentum")
    ).step(0.06, 2),
    Status.NOT_FINITE: infinite,
    Status.WRONG_METHOD: lambda _: Simulation(car(), settings=Settings(method="radau_5")).step(0.01),
    Status.START_REFUSED: lambda _: Simulation(car(PlaneRoad()), pose=Pose(z=-0.3)),
    Status.UNRESOLVED: lambda _: Simulation(system_of("cart_pole"), settings=Settings(max_halvings=4)).step(1e-3, 600),
    Status.NO_TREE: lambda _: Simulation(car(), settings=Settings(method="semi_recursive")).step(0.01),
    Status.TOO_STIFF: lambda _: Simulation(
        sliding(1.0, 5000.0), settings=Settings(method="runge_kutta_8", max_halvings=0)
    ).step(0.1, 50),
    Status.TOO_FAR: lambda _: Simulation(car(), pose=Pose(x=1e300)),
    Status.NO_EQUILIBRIUM: lambda _: Simulation(compile(hanging()), parameters={"k": 0.0, "payload": 1.0}),
    Status.TOO_MUCH_WORK: lambda _: Simulation(system_of("flyball"), settings=Settings(max_halvings=16)).step(1.0),
    Status.BEYOND_TABLE: beyond,
    Status.BAD_INERTIA: lambda _: Simulation(thrown(DRAWN, True), parameters={"xx": 2.0}),
    Status.TURNS_TOO_FAR: turning,
}


def by(method: str, system: System, h: float = 0.01) -> None:
    Simulation(system, settings=Settings(method=method)).step(h, 10)


def assembled(_: Path) -> None:
    Simulation(system_of("pendulum")).restore(Simulation(system_of("pendulum")).save())


def in_the_table(_: Path) -> None:
    Simulation(compile(number_model(np.linspace(-0.5, 0.5, 9)))).step(0.001, 252)


REMEDIES: dict[Status, Cause_] = {
    Status.BAD_FILE: lambda _: LoadedSystem(compile(driven_four_bar(5.0)).to_bytes()),
    Status.BAD_STATE: assembled,
    Status.NOT_INITIALISED: lambda _: started(four_bar()).step(0.01),
    Status.FIXED_PARAMETER: lambda _: Simulation(thrown(DRAWN, True), parameters={"mass": 1.0}).step(0.01),
    Status.NOT_CONVERGED: lambda _: Simulation(
        compile(driven_four_bar(5.0)), settings=Settings(max_iterations=1, max_halvings=0, method="energy_momentum")
    ).step(1e-5, 2),
    Status.WRONG_METHOD: lambda _: by("ali3p", car()),
    Status.START_REFUSED: lambda _: Simulation(car(PlaneRoad()), pose=Pose(z=0.0)),
    Status.UNRESOLVED: lambda _: Simulation(system_of("cart_pole")).step(1e-5, 50_000),
    Status.NO_TREE: lambda _: by("ali3p", car()),
    Status.TOO_STIFF: lambda _: [by(method, sliding(1.0, 5000.0), 0.1) for method in ("ali3p", "radau_5")],
    Status.TOO_FAR: lambda _: Simulation(car(), pose=Pose(x=1e7)),
    Status.NO_EQUILIBRIUM: lambda _: Simulation(compile(hanging()), parameters={"k": 90.0, "payload": 1.0}),
    Status.TOO_MUCH_WORK: lambda _: Simulation(system_of("flyball"), settings=Settings(max_halvings=16)).step(
        0.001, 1000
    ),
    Status.BEYOND_TABLE: in_the_table,
    Status.BAD_INERTIA: lambda _: Simulation(thrown(DRAWN, True), parameters={"xx": 0.35}),
    Status.TURNS_TOO_FAR: lambda _: Simulation(
        compile(WHEELS["armature"](60.0).model), settings=Settings(max_halvings=0)
    ).step(0.005, 200),
}
"""What is refused above, done as its remedy says."""


@pytest.mark.parametrize("status", REMEDIES, ids=lambda status: status.name)
def test_its_remedy_helps(status: Status, tmp_path: Path) -> None:
    REMEDIES[status](tmp_path)


ELSEWHERE = {Status.BRANCH_CHANGED, Status.ROAD_LOST, Status.WHEEL_IN_ROAD, Status.BAD_NORMAL}
"""By tests/simulation/test_assembly_modes.py, tests/roads/test_road_file.py and test_steep_faces.py, and
tests/vehicle/test_road_port.py."""


def test_every_status_is_caused() -> None:
    assert {*KERNEL, *PYTHON, *ELSEWHERE} == {*Status} - {Status.OK}


@pytest.mark.parametrize("status", KERNEL, ids=lambda status: status.name)
def test_the_kernel_ends_with_it(status: Status, tmp_path: Path) -> None:
    with pytest.raises(KernelError) as refused:
        KERNEL[status](tmp_path)
    assert refused.value.status == status


@pytest.mark.parametrize("status", [Status.BAD_FILE, Status.NO_MEMORY], ids=lambda status: status.name)
def test_a_refused_system_is_reported_with_a_remedy(status: Status, tmp_path: Path) -> None:
    with pytest.raises(KernelError, match="^the System file was refused: ") as refused:
        KERNEL[status](tmp_path)
    assert refused.value.message.endswith(f". {status_remedy(status)}")


@pytest.mark.parametrize("status", PYTHON, ids=lambda status: status.name)
def test_python_reports_message_and_remedy(status: Status, tmp_path: Path) -> None:
    with pytest.raises(SimulationError) as refused:
        PYTHON[status](tmp_path)
    assert refused.value.status == status
    assert isinstance(refused.value.__cause__, KernelError)
    text = str(refused.value)
    assert f": {load_library().ali3_status_text(status).decode()}" in text
    has_remedy = status != Status.SINGULAR  # here at a start, where no step can be shorter
    assert text.count(status_remedy(status)) == has_remedy
    assert ("Worst " in text) <= (status_cause(status) in (Cause.START, Cause.EQUATIONS))


def test_a_remedy_is_a_sentence() -> None:
    for status in {*Status} - {Status.OK}:
        remedy = status_remedy(status)
        assert remedy[0].isupper() or remedy[0] == "'", status
        assert remedy.endswith("."), status
    assert status_remedy(Status.OK) == ""
