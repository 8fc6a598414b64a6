"""Code generated for a System: the bits of the kernel's loops, and which System it is for."""

import copy
import ctypes
import importlib.util
import pickle
from importlib import import_module

import pytest

import mbs
from mbs.compiler.generated import source
from mbs.compiler.generated.library import library_of
from mbs.elements.road import KerbRoad
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.simulation.prepared_system import prepared
from mbs.system.system import System
from mbs.vehicle import load
from tests.quick import quick

SMALL = ("pendulum", "cart_pole", "slider_crank", "double_four_bar", "spatial_slider_crank", "flyball")
LARGE = ("bricard", "bicycle", "spatial_chain", "spinning_beam")
CARS = ("prototype", "hatchback", "saloon", "commonroad_320i", "ferrari_250_lm")
EDGE = KerbRoad(1.0, 0.05, 0.05, "after", 1.0)


def scene(name: str) -> System:
    return mbs.compile(import_module(f"mbs.scenes.{name}").build())


def car(name: str, fidelity: int = 0) -> System:
    return mbs.compile(load(name).model(EDGE, fidelity=fidelity))


def instances(system: System) -> tuple[Instance, Instance]:
    """One that is interpreted, one with generated code."""
    data = system.kernel_bytes()
    plain, other = LoadedSystem(data), LoadedSystem(data)
    other.attach(library_of(system))
    return Instance(plain), Instance(other)


def same_steps(one: Instance, other: Instance, h: float, steps: int) -> int:
    """Steps until both end alike; states have the same bytes after each."""
    for k in range(steps):
        messages = []
        for instance in (one, other):
            try:
                instance.step(h)
                messages.append("")
            except KernelError as error:
                messages.append(str(error))
        assert messages[0] == messages[1]
        assert one.save() == other.save(), f"step {k}"
        if messages[0]:
            return k
    return steps


@pytest.mark.parametrize(
    "name", [*SMALL, *(pytest.param(n, marks=pytest.mark.slow) for n in LARGE)]
)  # cart_pole is refused at last, both alike
def test_scenes_have_the_bits_of_the_interpreter(name: str) -> None:
    one, other = instances(scene(name))
    one.initialise()
    other.initialise()
    assert same_steps(one, other, 0.005, 100) > 80
    assert one.report() == other.report()


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype", "commonroad_320i"), CARS, "proof"))
def test_cars_have_the_bits_of_the_interpreter(name: str) -> None:
    """Fast over an edge, with some steering, so that tyres leave the ground and come back."""
    _drive(car(name))


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", [3, 10])
def test_other_models_of_a_car_have_them_too(fidelity: int) -> None:
    _drive(car("prototype", fidelity))


def _drive(system: System, **parameters: float) -> None:
    native = copy.copy(system)
    native.native = library_of(system)
    assert _states(system, parameters) == _states(native, parameters)


def _states(system: System, parameters: dict[str, float]) -> list[bytes]:
    car = mbs.Simulation(system, inputs={"steering": 0.3}, pose=mbs.Pose(speed=12.0), parameters=parameters)
    states = []
    for k in range(60):
        car.step(0.01 if k % 3 else 0.004)
        states.append(car.save())
    return states


@pytest.mark.slow
def test_parameters_are_read_when_they_are_set() -> None:
    system = car("prototype")
    for parameters in (
        {"front.alignment.toe_left": 0.02, "rear.alignment.camber_right": -0.03},
        {"payload.passenger.mass": 120.0, "chassis.mass": 300.0, "chassis.products.xy": 5.0},
        {"steering.rack_per_turn": 0.07, "drive.ratio_factor": 1.2},
    ):
        _drive(system, **parameters)
        assert _states(system, parameters) != _states(system, {})


def test_instances_share_nothing() -> None:
    system = scene("flyball")
    loaded = LoadedSystem(system.kernel_bytes())
    loaded.attach(library_of(system))
    alone, one, other = (Instance(loaded) for _ in range(3))
    for instance in (alone, one, other):
        instance.initialise()
    expected = []
    for _ in range(20):
        alone.step(0.005)
        expected.append(alone.save())
    for state in expected:
        other.step(0.002)
        one.step(0.005)
        assert one.save() == state


def test_code_of_another_system_is_refused() -> None:
    library = library_of(scene("pendulum"))
    other = LoadedSystem(scene("slider_crank").kernel_bytes())
    with pytest.raises(KernelError, match=r"refused: the code was generated for another System, of structure [0-9a-f]"):
        other.attach(library)


def test_code_of_another_table_or_processor_is_refused() -> None:
    system = scene("pendulum")
    loaded = LoadedSystem(system.kernel_bytes())
    version, *rest = (ctypes.c_uint32 * 4).in_dll(ctypes.CDLL(str(library_of(system))), source.TABLE)
    wrong = (ctypes.c_uint32 * 64)(version + 1, *rest)
    message = ctypes.create_string_buffer(256)
    attach = loaded._library.ali3_system_attach
    assert attach(loaded._handle, ctypes.addressof(wrong), message, len(message)) != 0
    assert f"for version {version + 1}".encode() in message.value
    assert attach(loaded._handle, None, None, 0) != 0


def test_systems_of_one_structure_share_their_code() -> None:
    """Lengths and masses are read; what has another number of joints is another structure."""
    one, two = (mbs.compile(import_module("mbs.scenes.pendulum").build(length=length)) for length in (1.0, 1.7))
    assert library_of(one) == library_of(two)
    loaded, plain = LoadedSystem(two.kernel_bytes()), LoadedSystem(two.kernel_bytes())
    loaded.attach(library_of(one))
    first, second = Instance(plain), Instance(loaded)
    first.initialise()
    second.initialise()
    assert same_steps(first, second, 0.01, 50) == 50


def test_compile_attaches_it_to_simulations() -> None:
    """Also after pickling, and not to a System with other arrays."""
    system = mbs.compile(import_module("mbs.scenes.slider_crank").build(), native=True)
    assert system.native is not None
    again = pickle.loads(pickle.dumps(system))
    assert again.native == system.native
    assert prepared(again).loaded.has_code
    assert not prepared(scene("slider_crank"))[0].has_code
    assert system.with_arrays({"q0": system.arrays["q0"]}).native is None
    one, other = mbs.Simulation(again), mbs.Simulation(scene("slider_crank"))
    for _ in range(20):
        one.step(0.002)
        other.step(0.002)
    assert one.save() == other.save()


def test_without_a_compiler_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(mbs.ModelError, match=r"needs a C compiler, .* the extra 'fmu' brings it"):
        library_of(scene("pendulum"))
