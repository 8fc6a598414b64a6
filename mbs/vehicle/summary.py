"""Tables of text that summarise a car."""

from ali3.columns import in_columns
from mbs.vehicle.built_car import BuiltCar


def summary(car: BuiltCar) -> str:
    """Table of loads, dimensions and parts of a car, with its equilibrium."""
    rest = car.rest
    loads = {axle: 2.0 * rest.load[axle] for axle in ("front", "rear")}
    total = loads["front"] + loads["rear"]
    rows = [
        ("car", f"{car.name}: {car.description}"),
        ("file", str(car.folder)),
        ("length, width", f"{car.vehicle.length:g} m, {car.vehicle.width:g} m"),
        ("steering", f"{car.steering.kind}, {car.steering.wheel_angle_max:.2f} rad of steering wheel to each side"),
        ("drive", f"{car.drive.kind}, {car.drive.wheels} wheels"),
        ("chassis", "rigid" if not car.has_frame else "rigid, or flexible by its frame"),
        ("parameters", f"{len(car.values())} of the file in the FMU"),
        *(grip_row(car, name) for name in car.axles),
    ]
    axles = [
        (
            name,
            axle.suspension.kind,
            f"{loads[name]:.0f} N, {loads[name] / (total or 1.0):.1%}",
            f"{abs(rest.spring_force[name]):.0f} N over {rest.spring_length[name]:.4f} m",
            f"{1e3 * rest.travel[name]:+.1f} mm",
            f"{axle.tyre.kind}, {axle.tyre.radius:g} m, pressed in by {1e3 * rest.deflection[name]:.1f} mm",
        )
        for name, axle in car.axles.items()
    ]
    titles = ("at rest", "suspension", "load", "a spring", "wheels from the drawing", "tyres, free radius")
    return "\n".join([*in_columns(rows), "", *in_columns(list(zip(titles, *axles, strict=True)))])


def grip_row(car: BuiltCar, axle: str) -> tuple[str, str]:
    """Coefficients that the tyres of an axle reach on the car's road, and the factor on the forces of the file.

    `axle`: "front" or "rear".
    """
    tyre = (car.front if axle == "front" else car.rear).tyre
    scale = car.road.grip_of(tyre)
    longitudinal, lateral = (scale * friction for friction in tyre.friction)
    return (
        f"{axle} grip",
        f"{longitudinal:.4g} longitudinal, {lateral:.4g} lateral: largest force over a load of {tyre.nominal_load:g} "
        f"N; forces and slips of the file times {scale:.4g}, which is {car.road.key('friction')} x "
        f"{car.road.key('friction_factor')} x {tyre.key('grip')} / {tyre.key('reference_friction')}",
    )


def parameter_table(car: BuiltCar) -> str:
    """Key path, value, unit and range of each number that the FMU has as a parameter."""
    rows = [("parameter", "value", "unit", "least", "most", "may change")]
    for quantity, path, value in car.parameters():
        when = "while driving" if quantity.change == "tunable" else "before the start"
        rows.append((path, f"{value:g}", quantity.unit, f"{quantity.least:g}", f"{quantity.high:g}", when))
    return "\n".join(in_columns(rows))
