"""A car as checked content of a file, which adds its parts to a model."""

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from pydantic import ValidationError

from ali3.message_text import one_line
from ali3.plausibility import Plausibility, Summarised, plausibility_of
from ali3.typed_sentences import Sentences
from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.elements.road import Road, RoadOfFile
from mbs.model.carried_parts import Spin
from mbs.model.model import Model
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.chassis.flexible_chassis import flexible_chassis, make_frame
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.ground_contact import ground_contact
from mbs.vehicle.chassis.mass_parameters import write_inertia
from mbs.vehicle.chassis.mount import rigid_chassis
from mbs.vehicle.checks.car_checks import car_faults, car_oddities
from mbs.vehicle.checks.equilibrium import Rest, find_equilibrium, rest_outputs
from mbs.vehicle.checks.ground import level_within, warn_of_steep_face
from mbs.vehicle.checks.working_ranges import working_ranges
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.errors import CarFileError, CarWarning
from mbs.vehicle.fidelity import OFFERED, Fidelity
from mbs.vehicle.inputs import driver_inputs
from mbs.vehicle.names import NAME_WORDS, PATTERN_WORDS
from mbs.vehicle.outputs import car_outputs
from mbs.vehicle.plausibility.car_plausibility import car_plausibility
from mbs.vehicle.port_parts import force_ports, road_ports, torque_ports, wind_port
from mbs.vehicle.schema_version import check_version
from mbs.vehicle.shapes.car_shapes import car_shapes
from mbs.vehicle.steering.steering_section import Steered
from mbs.vehicle.table_axle import table_axle

MAX_FAULTS = 8


C = TypeVar("C", bound="BuiltCar")
Outputs: TypeAlias = Callable[[CarBuilder, Steered, Mapping[str, Spin]], None]
"""Adds the outputs of a car. Arguments: the builder, the steering, the spins of the wheels by name."""


class BuiltCar(Summarised, CarContent):
    """A car file whose parts are added to a model; a `Car` makes the model itself."""

    @cached_property
    def flexible_frame(self) -> FlexibleFrame:
        """The frame with its modes.

        Raises
        ------
        ModelError
            The car has no flexible frame, or its files do not describe one that fits the car.
        """
        return make_frame(self, self._builder(self.empty(), None), self.mechanism)

    @cached_property
    def misfit(self) -> str:
        """Why a frame with `or_rigid` does not fit the car, which is then rigid; empty if it fits."""
        if self.chassis.frame is None or not self.chassis.frame.or_rigid:
            return ""
        try:
            frame = self.flexible_frame
            if frame.section.loads is not None and self.steering.on_flexible_chassis:
                frame.recorded_loads()
        except ModelError as error:
            return str(error)
        return ""

    @cached_property
    def rest(self) -> Rest:
        """The car at rest on its own tyres, computed with a model of few outputs.

        Raises
        ------
        ModelError
            The car has no equilibrium.
        """
        car = self
        if self.ports.tyre is not None:
            car = checked_car(type(self), _without_tyre_port(self._data), self.folder, self.name, at_rest=False)
        return find_equilibrium(car.build(car.empty(), outputs=rest_outputs).m, car)

    @property
    def has_frame(self) -> bool:
        """Whether the car has a flexible frame that fits it."""
        return self.chassis.frame is not None and not self.misfit

    @in_one_thread
    def build(
        self,
        m: Model,
        road: Road | RoadOfFile | None = None,
        fidelity: Fidelity = Fidelity.RIGID,
        drive: Callable[[Affine], object] | None = None,
        *,
        outputs: Outputs | None = None,
    ) -> CarBuilder:
        """Add the car to a model from `empty`; `road`, `fidelity`: as in `Car.model`.

        `drive`: prescribes the x coordinate of the chassis' reference point, m; the selector is then in neutral;
        `outputs`: adds the outputs of the car, by default all those of its FMU.
        """
        if not fidelity.rigid and not self.steering.on_flexible_chassis:
            raise ModelError(
                f"{self.steering.key('kind')} is '{self.steering.kind}', which needs a rigid chassis, fidelity "
                f"{Fidelity.RIGID.value}; for fidelity {fidelity.value} take 'rack_by_angle'."
            )
        if not fidelity.rigid and self.misfit:
            raise ModelError(f"The car '{self.name}' has fidelity 0 only: its frame does not fit it. {self.misfit}")
        flexible = None if fidelity.rigid else self.flexible_frame
        outputs = outputs or partial(car_outputs, self, self.flexible_frame if self.has_frame else None)
        b = self._builder(m, road)
        if road is not None:
            warn_of_steep_face(road, max(self.front.tyre.radius, self.rear.tyre.radius))
        with m.together():
            if flexible is None:
                b.chassis = rigid_chassis(m, self.chassis)
            else:
                b.chassis = flexible_chassis(m, self.chassis, flexible, fidelity)
            write_inertia(b, self.chassis)
            for name, payload in self.payload.items():
                payload.build(b, name)
            (steered, front), (_, rear) = self.by_tables(b) if fidelity is Fidelity.TABLE else self.mechanism(b)
            spins = front | rear
            if self.ports.torque is None:
                self.drive.build(b, spins, neutral=drive is not None)
            else:
                torque_ports(b, spins, self.drive, self.ports.torque)
            if self.ports.forces is not None:
                force_ports(b, self, self.ports.forces)
            self.aerodynamics.build(b, self.vehicle.reference_point, self.axles, wind_port(b))
            if self.chassis.ground_contact is not None:
                mass = self.vehicle.mass
                ground_contact(b, self.chassis.ground_contact, mass, lambda: self.flexible_frame.structure.joints)
            outputs(b, steered, spins)
            works = working_ranges(self)
            b.parameters(self.order, works)
            if self.ports.road is None:
                frictions = (f"{axle.tyre.reference_friction:.4g} ({name})" for name, axle in self.axles.items())
                self.road.parameters(m, road, b.road, ", ".join(frictions), works)
            if drive is not None:
                drive(b.chassis.frame.point(b.chassis.origin)[0])
            m.put_off(partial(car_shapes, b, self, spins, links=fidelity is not Fidelity.TABLE))
        return b

    @property
    def offered(self) -> tuple[Fidelity, ...]:
        """Fidelities of an FMU of the car.

        Only the rigid one if the car has no frame or a steering that needs a rigid chassis; no load paths if the frame
        has no table of loads.
        """
        frame = self.chassis.frame
        if frame is None or not (self.has_frame and self.steering.on_flexible_chassis):
            return OFFERED[:1]
        return tuple(f for f in OFFERED if f is not Fidelity.LOAD_PATHS or frame.loads is not None)

    def plausibility(self, what: str = "") -> list[Plausibility]:
        """Plausibility of the car, then of the tyres of each axle, then of its flexible frame.

        `what`: name of the file. Raises `ModelError` if the car has no equilibrium.
        """
        plausibilities = car_plausibility(what or str(self.folder), self, self.rest, self._data, self._changed_car)
        titles = ["car", *(f"{name} tyres" for name in self.axles)]
        if self.has_frame:
            plausibilities += self.flexible_frame.plausibility()
            titles.append("flexible frame")
        return [replace(plausibility, title=title) for plausibility, title in zip(plausibilities, titles, strict=True)]

    def _changed_car(self, data: dict[str, Any]) -> tuple[CarContent, Rest] | None:
        """The car of altered content, and the same car at rest; None if the content is not valid."""
        try:
            car = checked_car(type(self), data, self.folder, self.name, at_rest=False)
            return car, car.rest
        except (ModelError, ValueError):
            return None

    def empty(self) -> Model:
        """Make an empty model for the car."""
        return Model(f"{self.name} car", gravity=(0.0, 0.0, -GRAVITY))

    def _builder(self, m: Model, road: Road | RoadOfFile | None) -> CarBuilder:
        """Add road and inputs to an empty model."""
        m.floating = True
        m.start_in_equilibrium = self.ports.tyre is None and level_within(road, self.footprint)
        m.stop_time, m.step = 10.0, 0.002
        inputs = driver_inputs(m, self.ports)
        if self.ports.road is None:
            return CarBuilder(m, m.road(road or self.road.default(), file="road.file"), inputs, self.ports)
        if road is not None:
            raise ModelError(f"The road of the car '{self.name}' is at ports (ports.road); it takes no other.")
        whole_road, wheel_roads = road_ports(m, self.road)
        return CarBuilder(m, whole_road, inputs, self.ports, wheel_roads=wheel_roads)

    def mechanism(self, b: CarBuilder) -> Iterator[tuple[Steered, dict[str, Spin]]]:
        """Add steering and front axle, then the rear axle."""
        steered = self.steering.build(b, self.rack_direction)
        if not self.front.suspension.linked and steered.travel is not None:
            b.rack = steered.travel()
        yield steered, self.front.build(b, "front", steered.tie_rod, self.brakes.build)
        yield steered, self.rear.build(b, "rear", b.chassis.fixed_end, self.brakes.build)

    def by_tables(self, b: CarBuilder) -> Iterator[tuple[Steered, dict[str, Spin]]]:
        """Add the steering, and both axles with tables instead of links."""
        steered = self.steering.build(b, self.rack_direction)
        if steered.travel is None:
            raise ModelError(
                f"{self.steering.key('kind')} is '{self.steering.kind}', {self.steering.without_travel}: the "
                f"suspensions have no tables, fidelity {Fidelity.TABLE.value}, with it. Take "
                "'rack_by_angle' or fidelity 0."
            )
        b.rack = steered.travel()
        for name, axle in self.axles.items():
            if axle.suspension.linked:
                yield steered, table_axle(b, self, name, b.rack if name == "front" else None, self.brakes.build)
            else:
                yield steered, axle.build(b, name, steered.tie_rod, self.brakes.build)


@plausibility_of.register
def _plausibility_of_car(car: BuiltCar) -> list[Plausibility]:
    return car.plausibility()


def checked_car(
    kind: type[C],
    data: Mapping[str, Any],
    folder: Path,
    what: str,
    *,
    at_rest: bool = True,
    warn: bool = False,
    stacklevel: int = 3,
) -> C:
    """Make a car from the content of a file and check it.

    `kind`: class of the car; `folder`: folder of its tables; `what`: name of the file; `at_rest`: whether the
    equilibrium is checked; `warn`: whether to warn of unusual properties; `stacklevel`: stack level of the warnings, by
    default for the caller of `mbs.vehicle.load`. Raises `CarFileError` if the content does not describe a car.
    """
    check_version(data, what)
    try:
        car = kind.model_validate(data)
    except ValidationError as error:
        raise CarFileError(_fault_text(what, Sentences(kind, data, PATTERN_WORDS, NAME_WORDS).of(error))) from None
    car.locate("")
    car._folder = folder
    car._data = dict(data)
    try:
        for axle in (car.front, car.rear):
            axle.open(folder)
    except CarFileError as error:
        raise CarFileError(_fault_text(what, [str(error)])) from None
    faults = list(car_faults(car))
    if faults:
        raise CarFileError(_fault_text(what, faults))
    if not at_rest:
        return car
    if car.ports.tyre is not None:  # the equilibrium is that on its own tyres
        checked_car(kind, _without_tyre_port(data), folder, what, warn=warn, stacklevel=stacklevel + 1)
        return car
    rest = _check_at_rest(car, what)
    for sentence in _unusual_properties(car, rest) if warn else ():
        warnings.warn(f"{what}: {one_line(sentence)}", CarWarning, stacklevel=stacklevel)
    return car


def _check_at_rest(car: BuiltCar, what: str) -> Rest:
    """Check the frame of a car and the car as drawn; return its equilibrium. Raises `CarFileError` if there is none."""
    if car.has_frame:
        try:
            frame = car.flexible_frame
            if Fidelity.LOAD_PATHS in car.offered:
                frame.recorded_loads()
        except ModelError as error:
            raise CarFileError(_fault_text(what, [str(error)])) from error
    try:
        model = car.empty()
        car.build(model)
        model.look()
        return find_equilibrium(model, car)
    except ValueError as error:
        raise CarFileError(_fault_text(what, [f"as drawn it is not a valid car. {error}"])) from error


def _unusual_properties(car: BuiltCar, rest: Rest) -> Iterator[str]:
    """Yield a sentence for each unusual property of a car."""
    if car.misfit:
        yield f"fidelity 0 only, the frame does not fit the car. {car.misfit}"
    yield from car_oddities(car, rest)
    for plausibility in car_plausibility("", car, rest, car._data, car._changed_car):
        yield from plausibility.warnings()


def _without_tyre_port(data: Mapping[str, Any]) -> dict[str, Any]:
    """The content of a car file without the port of its tyres."""
    return {**data, "ports": {name: port for name, port in data["ports"].items() if name != "tyre"}}


def _fault_text(what: str, faults: Sequence[str]) -> str:
    """Lines of a message with the first `MAX_FAULTS` faults."""
    lines = [f"{what}: {one_line(fault)}" for fault in faults[:MAX_FAULTS]]
    if len(faults) > MAX_FAULTS:
        lines.append(f"{what}: {len(faults) - MAX_FAULTS} more faults.")
    return "\n".join(lines)
