"""Prepares a drive: the FMU, which must be a car that can be driven, its settings, its world and its drawing."""

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fmpy.model_description import ModelDescription

from ali3.columns import some_of
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import ROAD, FmuOptions
from hosts.common.package_names import check_world
from hosts.common.world_files import DEFAULT_WORLD, World, make_world, no_world
from hosts.fmu.description_record import description_record
from hosts.fmu.fmu import described
from hosts.fmu.fmu_file import FoundFmu, find_fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.geometry import scene_of
from hosts.fmu.settings import START_OF, Settings
from hosts.fmu.variables import Variables, check_co_simulation
from hosts.recordings.format import check_new

ITERATIONS = "solver.step_iterations"
_MAX_ITERATIONS = 6
"""Limit for an inner step of about 2 ms; its residual is measured in docs/fmu.md."""
_EMPTY_SCENE = {"format": "ALi3 scene", "version": 1, "extent": 5.0, "frames": {}, "shapes": []}
STEERING = ("steering", "steering_wheel_angle_demand", "steering_torque")
"""Inputs of which one is needed for steering."""
PEDALS = ("throttle", "brake")
POSE = ("chassis.x", "chassis.y", "chassis.z", "chassis.yaw")


@dataclass(frozen=True)
class DriveRequest:
    """Options of the command line on the car and its world."""

    fmu: Path | None
    world: str | None
    """Name or file."""
    place: str | None
    fidelity: float | None
    fmu_options: FmuOptions
    """Of ``--set`` and ``--parameters``."""
    aliases: Path | None
    record: Path | None
    manoeuvre: str = ""
    """Name of a manoeuvre, or empty."""
    start: Callable[[Collection[str]], Mapping[str, Value]] = lambda names: {}
    """Start values of the manoeuvre for the variables of the FMU; other settings replace them."""


@dataclass(frozen=True)
class Prepared:
    """A checked car, ready to start."""

    fmu: FoundFmu
    description: ModelDescription
    variables: Variables
    source: FmuSource
    settings: Settings
    """Settings of the FMU, including the road and the place."""
    world: World
    scene: dict[str, Any] | None
    """The drawing of the FMU without roads, if it has one."""

    def hello(
        self, constants: Mapping[str, float], columns: tuple[str, ...], step: float, record: str
    ) -> dict[str, Any]:
        """The first message to a page, under ALi3 names."""
        record_of_fmu = description_record(self.description, self.variables)
        names = self.source.called([v["name"] for v in record_of_fmu["variables"]])
        for variable, name in zip(record_of_fmu["variables"], names, strict=True):
            variable["name"] = name
        return {
            "description": record_of_fmu,
            "scene": self.scene or {**_EMPTY_SCENE, "name": self.description.modelName},
            "columns": list(columns),
            "constants": dict(constants),
            "step": step,
            "world": self.world.summary(),
            "recording": record,
        }

    def places(self) -> dict[str, dict[str, Value]]:
        """Start values by name of the places of the world, if the FMU has these parameters."""
        names = set(self.source.called(self.variables.names))
        return {n: values for n, values in self.world.places().items() if set(values) <= names}


def prepare(request: DriveRequest, tell: Callable[[str], None]) -> Prepared:
    """Find, check and read what a drive needs. `tell`: called with messages.

    Raises `HostError` with a remedy if something is wrong or cannot be used.
    """
    if request.record is not None:
        check_new(request.record)
    if request.world is not None:
        check_world(request.world)
    with ThreadPoolExecutor() as pool:
        world_task = (
            None if request.fmu is not None else pool.submit(_requested_world, request, tell)
        )  # in parallel with finding the FMU
        fmu = find_fmu(request.fmu, tell)
        description = described(fmu.path)
        check_co_simulation(fmu.path, description)
        variables = Variables(description)
        source = FmuSource.named(fmu.path, variables, request.aliases)
        scene_task = pool.submit(scene_of, fmu.path)
        _check_road(request, fmu.path, ROAD in source.called(variables.names))
        if ROAD not in source.called(variables.names):
            world = None
        else:
            world = _requested_world(request, tell) if world_task is None else world_task.result()
        scene = scene_task.result()
    if world is None:
        world = no_world([] if scene is None else scene["roads"])
    settings = _settings(request, source, variables, world)
    inputs = source.called(_names(variables, "input"))
    outputs = source.outputs(_names(variables, "output"))
    message = not_drivable(fmu.path, inputs, outputs, scene is not None)
    if message:
        tell(message)
    for item in [] if scene is None else scene["missing"]:
        tell(f"{item['name']} is not drawn: {item['why'].rstrip('.')}.")
    return Prepared(
        fmu, description, variables, source, settings, world, None if scene is None else scene | {"roads": []}
    )


def _names(variables: Variables, causality: str) -> list[str]:
    return [name for name in variables.names if variables[name].causality == causality]


def _check_road(request: DriveRequest, path: Path, has_road_file: bool) -> None:
    """Refuse a world if another road is given, or if the FMU has no road file."""
    if request.world is None:
        return
    if ROAD in dict(request.fmu_options.values):
        raise HostError(f"The road is given by --world and by --set {ROAD}; give it once.")
    if not has_road_file:
        raise HostError(
            f"{path} has no parameter '{ROAD}', so that the world {request.world} cannot be put under it; without "
            "--world it is driven on its own ground."
        )


def _requested_world(request: DriveRequest, tell: Callable[[str], None]) -> World | None:
    """The requested world, by default the proving ground; None if the user sets a road."""
    if request.world is not None:
        return make_world(request.world, tell)
    if ROAD in dict(request.fmu_options.values):
        return None
    try:
        return make_world(DEFAULT_WORLD, tell)
    except HostError as error:
        tell(f"The world {DEFAULT_WORLD} cannot be made; the car is driven on its own road. {error}")
        return None


def _settings(request: DriveRequest, source: FmuSource, variables: Variables, world: World) -> Settings:
    """Settings of the world, the place and the manoeuvre, then those of the user."""
    start: dict[str, Value] = {} if world.road is None else {ROAD: str(world.road)}
    places = world.places()
    if request.place is not None and request.place not in places:
        near = did_you_mean(request.place, places, f"it has: {', '.join(places) or 'none'}")
        raise HostError(f"The world {world.name or 'of this FMU'} has no place '{request.place}'{near}")
    place = request.place if request.place is not None else next(iter(places), None)
    if place is not None:
        start |= places[place]
    start = {name: value for name, value in source.fmu_values(start).items() if name in variables.names}
    settings = Settings(variables)
    if ITERATIONS in variables.names:
        settings.add_numbers({ITERATIONS: _MAX_ITERATIONS}, "real time")
    settings.add_numbers(start, f"the world {world.name}")
    settings.add_numbers(request.start(variables.names), f"{START_OF}{request.manoeuvre}")
    settings.add_options(request.fmu_options, request.fidelity)
    return settings


def missing_variables(inputs: Collection[str], outputs: Collection[str]) -> tuple[list[str], list[str]]:
    """Missing inputs and outputs that driving needs."""
    steering = [] if any(name in inputs for name in STEERING) else [STEERING[0]]
    pedals = [name for name in PEDALS if name not in inputs]
    return steering + pedals, [name for name in POSE if name not in outputs]


def not_drivable(path: Path, inputs: Sequence[str], outputs: Sequence[str], has_drawing: bool) -> str:
    """Sentences on what an FMU lacks to be driven, a remedy, and what works without; empty if nothing is missing.

    `inputs`, `outputs`: ALi3 names, after aliases.
    """
    missing_inputs, missing_outputs = missing_variables(inputs, outputs)
    lacks = [f"no input {', '.join(missing_inputs)}"] if missing_inputs else []
    lacks += [f"no output {', '.join(missing_outputs)}"] if missing_outputs else []
    if not lacks:
        return ""
    subject = "its inputs that have ALi3 names can be moved; it" if len(missing_inputs) < len(PEDALS) + 1 else "it"
    picture = "" if has_drawing else ", but is not drawn, since it has no drawing"
    return (
        f"{path.name} has {' and '.join(lacks)}, which driving needs. If it has them under other names, an alias file "
        f"says so (--aliases FILE). Its inputs are {some_of(inputs)}; its outputs {some_of(outputs)}. As it is, "
        f"{subject} runs, can be paused, slowed down, reset and recorded{picture}."
    )
