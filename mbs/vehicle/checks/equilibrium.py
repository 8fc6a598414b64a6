"""The car at rest, and its differences from the drawing."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.errors import ModelError
from mbs.compiler.model_to_system import compiled
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.model import Model
from mbs.simulation.unstepped_system import StandingSystem
from mbs.system.compiled_model import CompiledModel
from mbs.vehicle.axes import LEFT, UP
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.steering.steering_section import Steered

MAX_TRAVEL = 0.02  # m, of a wheel from the drawing to rest
MAX_DEFLECTION_ERROR = 0.005  # m, of a tyre at rest against the drawing
LENGTH_TOLERANCE = 1e-6  # m, of fitted free lengths
MAX_DOUBLINGS = 5  # of the range in which they are sought
MAX_LEAN = math.radians(0.5)


@dataclass(frozen=True)
class Rest:
    """The car at rest."""

    travel: dict[str, float]
    """Wheel travel from the drawing by axle, mean of both sides, m, positive in bump."""
    load: dict[str, float]
    """Load of a wheel by axle, mean of both sides, N."""
    spring_force: dict[str, float]
    """Force of a spring by axle, mean of both sides, N."""
    deflection: dict[str, float]
    """Deflection of a tyre by axle, mean of both sides, m."""
    spring_length: dict[str, float]
    """Length of the springs by axle, m."""
    lean: float
    """Roll angle, rad, positive with the left side up."""
    compiled: CompiledModel
    """Compiled model of the car."""

    def oddities(self, car: CarContent) -> Iterator[str]:
        """Yield a sentence for each difference from the drawing."""
        yield from self._travel_oddities(car)
        for name, axle in car.axles.items():
            drawn, deflection = axle.tyre.radius - axle.wheel.centre[2], self.deflection[name]
            if abs(deflection - drawn) > MAX_DEFLECTION_ERROR:
                yield (
                    f"{axle.tyre.key('stiffness')} is {axle.tyre.stiffness:g} N/m: at rest the load of "
                    f"{self.load[name]:.0f} N compresses the tyre by {deflection:.3g} m, but {axle.tyre.key('radius')} "
                    f"minus the height of {axle.wheel.key('centre')} is {drawn:.3g} m."
                )
        if abs(self.lean) > MAX_LEAN:
            yield (
                f"at rest the car leans by {math.degrees(abs(self.lean)):.2g} deg to the "
                f"{'right' if self.lean > 0.0 else 'left'}: its masses are not balanced sideways, or "
                "a spring is soft."
            )

    def _travel_oddities(self, car: CarContent) -> Iterator[str]:
        """Yield a sentence for each axle whose wheels are not at the drawn height, with the free length that fits."""
        displaced = [name for name, travel in self.travel.items() if abs(travel) > MAX_TRAVEL]
        fitted_lengths = _fitted_lengths(self, car, displaced) if displaced else {}
        for name, axle in car.axles.items():
            travel = self.travel[name]
            if abs(travel) > MAX_TRAVEL:
                remedy = (
                    f": with {axle.spring.key('free_length')} = {fitted_lengths[name]:.6g} it is"
                    if fitted_lengths
                    else ""
                )
                spring = axle.spring
                values = [f"{spring.key('free_length')} {spring.free_length:g} m"]
                values += [f"stiffness {spring.stiffness:g} N/m"] if spring.stiffness is not None else []
                yield (
                    f"at rest the {name} wheels stand {abs(travel):.3g} m {'higher' if travel > 0.0 else 'lower'} "
                    f"in the chassis than {axle.wheel.key('centre')} is drawn, at a load of {self.load[name]:.0f} N "
                    f"each and {abs(self.spring_force[name]):.0f} N in each spring ({', '.join(values)}); a car is "
                    f"drawn in its equilibrium{remedy}."
                )


def travel_output(m: Model, chassis: Body, spin: Spin, w: str) -> None:
    """Add the travel of a wheel relative to the chassis as a sensor. `w`: name of the wheel."""
    gap: AffineVector = spin.centre - chassis.point(spin.centre.value(m.drawn()))
    m.sense_vector(
        f"wheel_{w}.travel", gap, [chassis.vector(UP)], description="travel of the wheel centre, positive in bump"
    )


def rest_outputs(b: CarBuilder, steered: Steered, spins: Mapping[str, Spin]) -> None:
    """Add the sensors that `find_equilibrium` needs."""
    chassis = b.chassis.frame
    for w, spin in spins.items():
        travel_output(b.m, chassis, spin, w)
        for name, element, output in (
            (f"wheel_{w}.Fz", f"tyre {w}", "vertical_force"),
            (f"wheel_{w}.deflection", f"tyre {w}", "deflection"),
            (f"spring_{w}.force", f"spring {w}", "force"),
            (f"spring_{w}.length", f"spring {w}", "length"),
        ):
            b.m.sense_element(name, element, output)
    b.m.sense_vector("chassis.roll", AffineVector.constant(UP), [chassis.vector(UP), chassis.vector(LEFT)])


def _fitted_lengths(rest: Rest, car: CarContent, axles: Sequence[str]) -> dict[str, float]:
    """Free lengths of the springs of axles with which the car stands as drawn, m (Brent's method); empty if none."""
    from scipy.optimize import brentq  # its import is slow and seldom needed

    lengths = {car.axles[name].spring.key("free_length"): car.axles[name].spring.free_length for name in axles}
    keys = dict(zip(axles, lengths, strict=True))

    def travel(length: float, name: str) -> float:
        sensors = StandingSystem(rest.compiled, lengths | {keys[name]: length}).sensors
        return _mean(sensors, "wheel_{}.travel", name)

    try:
        for name in (*axles, *(axles if len(axles) > 1 else ())):  # a second time: the axles influence each other
            begin = lengths[keys[name]]
            offset = travel(begin, name)
            candidates = [begin + 2.0**k * offset for k in range(MAX_DOUBLINGS)]  # a low car needs longer springs
            bound = next((x for x in candidates if travel(x, name) * offset < 0.0), None)
            if bound is None:
                return {}
            lengths[keys[name]] = float(brentq(travel, begin, bound, args=(name,), xtol=LENGTH_TOLERANCE))
    except ModelError:
        return {}
    return {name: lengths[keys[name]] for name in axles}


def _mean(sensors: Mapping[str, float], name: str, axle: str) -> float:
    """Mean of a sensor over both wheels of an axle. `name`: name of the sensor, with {} for the wheel."""
    return 0.5 * sum(sensors[name.format(f"{axle[0].upper()}{side}")] for side in "LR")


def find_equilibrium(model: Model, car: CarContent) -> Rest:
    """Compile the car and find its equilibrium. `model`: model with the sensors of `rest_outputs`.

    Raises `ModelError` if a number is not valid, or there is no equilibrium.
    """
    system = compiled(model)
    at_rest = StandingSystem(system).sensors

    def means(name: str) -> dict[str, float]:
        return {axle: _mean(at_rest, name, axle) for axle in car.axles}

    return Rest(
        means("wheel_{}.travel"),
        means("wheel_{}.Fz"),
        means("spring_{}.force"),
        means("wheel_{}.deflection"),
        means("spring_{}.length"),
        at_rest["chassis.roll"],
        system,
    )
