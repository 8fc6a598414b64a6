"""The driver of a manoeuvre, from the settings of its file and the constants of the FMU."""

import math
from collections.abc import Collection, Mapping
from dataclasses import fields, replace

from ali3.decimal_number import parse_number
from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.driving.course import course_of
from hosts.driving.manoeuvre import INITIAL_SPEED, Manoeuvre
from hosts.driving.pilots.course_follower import CourseFollower, DriverSettings
from hosts.driving.pilots.pilot import ACTS, OBSERVED, refuse_missing
from hosts.driving.simulated_fmu import SimulatedFmu

_POSITIVE = ("speed", "wheelbase", "wheel_angle_max", "vehicle_length", "vehicle_width")
CONSTANTS = {
    "wheelbase": "vehicle.wheelbase",
    "wheel_angle_max": "vehicle.front_wheel_angle_max",
    "vehicle_length": "vehicle.length",
    "vehicle_width": "vehicle.width",
}
"""Settings of a driver that are constants of the FMU, and the names of these."""


def make_driver(settings: Mapping[str, str], constants: Mapping[str, float]) -> CourseFollower:
    """Driver from the ``[driver]`` section of a manoeuvre and the constants of the FMU.

    `settings`: ``course`` and the fields of `DriverSettings`; they take precedence over the constants of the FMU;
    `constants`: constants of the FMU by name; see `CONSTANTS`. Raises `HostError` if a setting is unknown, not a
    number, or missing both there and in the FMU.
    """
    numbers = {name: constants[constant] for name, constant in CONSTANTS.items() if constant in constants}
    setting_names = {f.name for f in fields(DriverSettings)}
    for name, text in settings.items():
        if name == "course":
            continue
        if name not in setting_names:
            names = ["course", *sorted(setting_names)]
            near = did_you_mean(name, names, f"known are {', '.join(names)}")
            raise HostError(f"[driver] has '{name}'{near}")
        try:
            numbers[name] = parse_number(text)
        except ValueError as error:
            raise HostError(f"[driver] {name}: {error}.") from None
        if numbers[name] < 0.0 or (numbers[name] == 0.0 and name in _POSITIVE):
            sign = "positive" if name in _POSITIVE else "zero or positive"
            raise HostError(f"[driver] {name} is {numbers[name]:g}; it must be {sign}.")
    if "speed" not in numbers or "course" not in settings:
        raise HostError("[driver] needs a course and a speed.")
    for name, constant in CONSTANTS.items():
        if name not in numbers:
            raise HostError(
                f"The driver needs the {name.replace('_', ' ')} of the car, which this FMU does not provide (it has no "
                f"constant '{constant}'); give it as --driver {name}=NUMBER, or in [driver] of the manoeuvre."
            )
    values = DriverSettings(**numbers)
    return CourseFollower(course_of(settings["course"], values.vehicle_width), values)


def with_settings(
    manoeuvre: Manoeuvre, settings: Mapping[str, float], names: Collection[str], stop_time: float | None
) -> Manoeuvre:
    """The manoeuvre with settings of its driver in place of its own.

    `settings`: by name; `speed` is also that at the start, if it is a parameter among `names`, the variables of the
    FMU, and a lower one extends the stop time, in whole seconds, for the same distance; `stop_time`: requested, s,
    which is not extended. Raises `HostError` if the manoeuvre has no driver.
    """
    if settings and not manoeuvre.driver:
        raise HostError(f"The manoeuvre {manoeuvre.name} has no driver, so there is nothing to set by --driver.")
    driver = {**manoeuvre.driver, **{name: repr(value) for name, value in settings.items()}}
    start, speed, duration = dict(manoeuvre.start), settings.get("speed", 0.0), manoeuvre.stop_time
    if speed > 0.0:
        if INITIAL_SPEED in names:
            start[INITIAL_SPEED] = speed
        table_speed = manoeuvre.start.get(INITIAL_SPEED)
        if stop_time is None and isinstance(table_speed, (int, float)):
            duration = max(duration, math.ceil(duration * table_speed / speed))
    return replace(manoeuvre, driver=driver, start=start, stop_time=duration)


def check_drivable(inputs: Collection[str], outputs: Collection[str], subject: str) -> None:
    """Raises `HostError` if a driver lacks inputs or outputs of the FMU. `subject`: the FMU, for messages."""
    refuse_missing([n for n in ACTS if n not in inputs] + [n for n in OBSERVED if n not in outputs], subject)


def driver_of(fmu: SimulatedFmu, manoeuvre: Manoeuvre) -> CourseFollower | None:
    """The driver of a manoeuvre with the constants of the FMU; None if the manoeuvre has no driver.

    Raises `HostError` if the FMU is not a car for a driver, or a setting is wrong or missing.
    """
    if not manoeuvre.driver:
        return None
    check_drivable(fmu.names("input"), fmu.names("output"), fmu.path.name)
    return make_driver(manoeuvre.driver, fmu.constants())
