"""Ports of a car: what they replace is left out, loops through them converge to the closed car, works are booked."""

import numpy as np
import pytest

import mbs
from mbs.vehicle import CarFileError
from mbs.vehicle.car import Car
from mbs.vehicle.ports import chosen_ports
from tests.vehicle.cars_with_ports import (
    STEP,
    WHEELS,
    SecondDrive,
    hatchback,
    rigid,
    simulation,
    system,
    throttle_at,
    with_ports,
    works_of,
)
from tests.vehicle.rigid_car import column_car


def names(car: Car) -> tuple[list[str], list[str]]:
    m = car.model()
    return [i.name for i in m.inputs], [s.name for s in m.sensors]


@pytest.mark.slow
def test_a_copy_of_the_drive_in_a_second_place_gives_the_closed_car() -> None:
    """At 2 ms: wheel loads below 1 % of their mean, path below 0.2 % of its length."""
    closed, loop, drive = simulation(rigid), simulation(rigid, torque="half_shafts"), SecondDrive(rigid())
    loads: list[list[float]] = []
    for _ in range(1000):
        throttle, now = throttle_at(closed.time), loop.sensors
        for s in (closed, loop):
            s.set_input("steering", 0.15 * np.sin(3.0 * s.time))
        closed.set_input("throttle", throttle)
        torque = drive.torque(*(now[f"wheel_{drive.wheels}{side}.omega"] for side in "LR"), throttle, STEP)
        for side in "LR":
            loop.set_input(f"wheel_{drive.wheels}{side}.drive_torque", torque)
        for s in (closed, loop):
            s.step(STEP)
        first = closed.sensors
        loads.append([each[f"wheel_{w}.Fz"] for w in WHEELS for each in (first, now)])
    pairs = np.array(loads).reshape(-1, 4, 2)
    pairs = np.stack([pairs[:-1, :, 0], pairs[1:, :, 1]], axis=-1)  # the second was read before its step
    ends = [s.sensors for s in (closed, loop)]
    away = [np.array([end[f"chassis.{c}"] for c in "xy"]) for end in ends]
    assert ends[0]["speed"] > 10.3, "the drive has worked"
    assert np.sqrt(np.mean(np.diff(pairs) ** 2)) < 1e-2 * pairs.mean()
    assert np.linalg.norm(away[0] - away[1]) < 2e-3 * np.linalg.norm(away[0])


@pytest.mark.slow
def test_what_a_port_replaces_is_left_out_and_all_else_stays_in_its_order() -> None:
    inputs, sensors = names(rigid())
    faults = []
    gone = {
        "torque": ({"throttle", "selector"}, {"engine_speed", "gear", "drive_torque"}),
        "brakes": ({"brake"}, set()),
        "steering": ({"steering", "steering_wheel_angle_demand"}, {"steering_demand_excess", "energy.steering"}),
    }
    kinds = {"torque": "hub_motors", "brakes": "pressure", "steering": "rack_position"}
    for port, (no_inputs, no_sensors) in gone.items():
        mine, observation = names(with_ports(rigid(), **{port: kinds[port]}))
        no_sensors = no_sensors | {f"used.{name}" for name in no_inputs}
        if [n for n in mine if n in inputs] != [n for n in inputs if n not in no_inputs]:
            faults.append((port, mine))
        if [n for n in observation if n in sensors] != [n for n in sensors if n not in no_sensors]:
            faults.append((port, set(sensors) - set(observation) ^ no_sensors))
    assert not faults
    parameters = [p.name for p in with_ports(rigid(), torque="half_shafts", brakes="torque").model().parameters]
    assert not [n for n in parameters if n.startswith("drive.") or n in ("brakes.torque", "brakes.balance")]


def test_works_of_ports_close_the_balance() -> None:
    """To 1e-6 of the largest work, beside the step's own error."""
    s = simulation(rigid, torque="hub_motors", brakes="pressure")
    start = s.sensors
    for k in range(1000):
        s.set_input("wheel_RL.drive_torque", 250.0 * np.sin(k / 60))
        s.set_input("wheel_FR.drive_torque", 80.0)
        s.set_input("wheel_FL.brake_pressure", 1e6 if k > 600 else 0.0)
        s.step(STEP)
    end = s.sensors
    works = works_of(end)
    assert {"energy.ports", "energy.brakes"} <= set(works)
    assert works["energy.ports"] > 1e3
    assert works["energy.brakes"] < -1e2
    change = end["energy.total"] - start["energy.total"]
    own = abs(s.instance.report()["energy_error"])
    assert abs(change - sum(works.values())) < 1e-6 * max(map(abs, works.values())) + own


def open_and_own(s: mbs.Simulation, name: str, amplitude: float, parts: int) -> tuple[dict[str, float], float, float]:
    """Works of half a second of steering to and fro, asked for every 2 ms in steps of a part of that; what the sum of
    works leaves open of the change of the energy, and the error of the energy that the steps tell.
    """
    start = s.sensors
    for k in range(250):
        s.set_input(name, amplitude * np.sin(4.0 * np.pi * k * STEP))
        s.step(STEP / parts, parts)
    end = s.sensors
    works = works_of(end)
    change = end["energy.total"] - start["energy.total"]
    return works, change - sum(works.values()), s.instance.report()["energy_error"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ports", "name", "amplitude", "book"),
    [
        ({"steering": "rack_position"}, "steering_rack_demand", 0.005, "energy.ports"),
        ({}, "steering", 0.1, "energy.steering"),
    ],
)
def test_the_work_that_moves_the_rack_is_booked(ports: dict[str, str], name: str, amplitude: float, book: str) -> None:
    """The acceleration of the rack jumps with each demand. Work and error of the energy are of second order in the step
    all the same, and what they leave open of the change of the energy is below 1e-5 of the largest work. The work of a
    held demand is the step's own force times the travel: 0.0145, 0.0034 and 0.0008 J off in 1, 2 and 4 parts.
    """
    works, residuals, own = {}, {}, {}
    for parts in (1, 4, 16):
        of_all, residuals[parts], own[parts] = open_and_own(simulation(rigid, **ports), name, amplitude, parts)
        works[parts] = of_all[book]
        assert abs(residuals[parts] - own[parts]) < 1e-5 / parts * max(map(abs, of_all.values()))
    assert works[16] > 1.0
    assert abs(works[4] - works[16]) < 4e-3
    assert abs(works[1] - works[16]) < 2e-2
    assert abs(own[4]) < 0.01
    assert abs(own[16]) < 1e-3


@pytest.mark.slow
def test_the_reaction_of_hub_motors_is_on_the_carriers() -> None:
    """A driving hub motor turns its trailing arm down, and the spring by its pivot holds the torque: balance of moments
    about the pivot, against half shafts, whose reaction is on the body.
    """
    torque, relieved = 100.0, []
    for sign in (1.0, -1.0):
        forces = {}
        for kind in ("half_shafts", "hub_motors"):
            s = simulation(hatchback, 15.0, torque=kind)
            for side in "LR":
                s.set_input(f"wheel_R{side}.drive_torque", sign * torque)
            s.step(STEP, 800)
            now = s.sensors
            forces[kind] = now["spring_RL.force"]  # tension
            assert now["wheel_RL.drive_power"] == pytest.approx(sign * torque * now["wheel_RL.omega"], rel=0.01)
        relieved.append(sign * (forces["hub_motors"] - forces["half_shafts"]))
    points = hatchback()._data["rear"]["suspension"]["points"]
    pivot, lower, upper = (np.array(points[name]) for name in ("pivot", "spring_lower", "spring_upper"))
    distance = (upper - lower) / np.linalg.norm(upper - lower)
    lever = np.cross(lower - pivot, distance)[1]
    assert lever == pytest.approx(0.33, rel=0.01)
    assert lever * np.mean(relieved) == pytest.approx(torque, rel=0.03)


@pytest.mark.slow
def test_a_pressure_gives_the_torque_of_the_pedal_at_the_same_share_which_reports_it() -> None:
    pedal = simulation(rigid, outputs="loops", full_pressure=8e6)
    port = simulation(rigid, brakes="pressure", full_pressure=8e6)
    pedal.set_input("brake", 0.25)
    torque = simulation(rigid, brakes="torque")
    for w in WHEELS:
        port.set_input(f"wheel_{w}.brake_pressure", 2e6)
        brakes = rigid().brakes
        share = brakes.balance if w[0] == "F" else 1.0 - brakes.balance
        torque.set_input(f"wheel_{w}.brake_torque_demand", 0.25 * share * brakes.torque)
    for s in (pedal, port, torque):
        s.step(STEP, 250)
    first = pedal.sensors
    assert first["brake_pressure"] == 2e6
    for s in (port, torque):
        now = s.sensors
        for name in ("speed", "chassis.x", "wheel_FL.Fx", "wheel_RR.brake_torque"):
            assert now[name] == pytest.approx(first[name], rel=1e-9), name
    assert now["wheel_FL.brake_power"] == pytest.approx(now["wheel_FL.brake_torque"] * now["wheel_FL.omega"], rel=1e-2)


@pytest.mark.slow
def test_a_requested_torque_reports_its_pressure() -> None:
    """Of brakes as those of the car file, whose sides differ here: both cars brake alike."""
    result = {"brakes.side": 0.1, "ports.full_pressure": 8e6}
    cars = [hatchback().changed(result | {"ports.brakes": kind}) for kind in ("torque", "pressure")]
    torque, pressure = (mbs.Simulation(mbs.compile(car.model()), pose=mbs.Pose(speed=10.0)) for car in cars)
    for k, w in enumerate(WHEELS):
        torque.set_input(f"wheel_{w}.brake_torque_demand", 100.0 + 50.0 * k)
    torque.step(STEP, 50)
    for w in WHEELS:
        pressure.set_input(f"wheel_{w}.brake_pressure", torque.sensors[f"used.wheel_{w}.brake_pressure"])
    pressure.step(STEP, 50)
    for w in WHEELS:
        brake_torque = torque.sensors[f"wheel_{w}.brake_torque"]
        assert brake_torque < -90.0
        assert pressure.sensors[f"wheel_{w}.brake_torque"] == pytest.approx(brake_torque, rel=1e-9)


def test_outputs_of_loops_alone_leave_a_car_as_it_is() -> None:
    """The same inputs and bits; what is more stands behind, and damper, drive and brakes tell of their powers."""
    plain, more = (simulation(rigid, 12.0, **ports) for ports in ({}, {"outputs": "loops"}))
    assert [i["name"] for i in more.system.meta["inputs"]] == [i["name"] for i in plain.system.meta["inputs"]]
    for s in (plain, more):
        s.set_input("throttle", 0.4)
        s.set_input("steering", 0.2)
        s.step(STEP, 200)
    first, now = plain.sensors, more.sensors
    common = [n for n in now if n in first]
    assert common == list(first)
    assert [now[n] for n in common] == [first[n] for n in common]
    assert {"brake_pressure", "damper_FL.speed", "wheel_RL.drive_power", "wheel_FL.Mx"} <= now.keys() - first.keys()
    assert now["wheel_RL.drive_power"] == pytest.approx(now["wheel_RL.drive_torque"] * now["wheel_RL.omega"], rel=0.02)


def test_a_brake_by_torque_holds_the_standing_car() -> None:
    """It is what the brake can hold, not a torque that turns the wheel backwards."""
    s = simulation(rigid, 3.0, brakes="torque")
    for w in WHEELS:
        s.set_input(f"wheel_{w}.brake_torque_demand", 600.0)
    s.step(STEP, 1000)
    before = s.sensors
    s.step(STEP, 250)
    now = s.sensors
    assert all(abs(now[f"wheel_{w}.x"] - before[f"wheel_{w}.x"]) < 1e-3 for w in WHEELS)
    assert all(abs(now[f"wheel_{w}.brake_torque"]) < 600.0 for w in WHEELS)


def test_the_rack_follows_its_port() -> None:
    s = simulation(rigid, steering="rack_position")
    s.set_input("steering_rack_demand", 0.01)
    s.step(STEP, 50)
    now = s.sensors
    w = 2.0 * np.pi * 50.0
    assert now["steering_rack"] == pytest.approx(0.01 * (1.0 - (1.0 + w * 0.1) * np.exp(-w * 0.1)), rel=1e-6)


@pytest.mark.slow
def test_a_force_on_the_rack_relieves_the_steering_wheel() -> None:
    """In a standing start of a turn the force that the rods ask for is that of the actuator and of the pinion."""
    car, by_force = column_car(), {}
    for force in (0.0, 100.0):
        s = simulation(column_car, steering="rack_force")
        s.set_input("steering_wheel_angle_demand", 0.3)
        s.set_input("steering_rack_actuator_force", force)
        s.step(STEP, 1000)
        by_force[force] = s.sensors
    per_radian = car.steering.rack_per_turn / (2.0 * np.pi)
    relief = by_force[0.0]["steering_wheel_torque"] - by_force[100.0]["steering_wheel_torque"]
    rods = by_force[100.0]["steering_rack_force"] - by_force[0.0]["steering_rack_force"]
    direction = car.rack_direction
    assert abs(relief) > 0.1
    assert abs(relief - direction * per_radian * (100.0 + rods)) < 0.3 * abs(relief)


def test_outputs_that_loops_need_agree_with_others() -> None:
    s = simulation(hatchback, torque="half_shafts")
    s.set_input("steering", 0.2)
    s.set_input("wheel_FL.drive_torque", 300.0)
    s.step(STEP, 400)
    now = s.sensors
    yaw = now["chassis.yaw"]
    forward = np.cos(yaw) * now["chassis.earth_vx"] + np.sin(yaw) * now["chassis.earth_vy"]
    assert forward == pytest.approx(now["chassis.vx"], rel=1e-3)
    before = now
    s.step(STEP)
    now = s.sensors
    for w in WHEELS:
        radius = np.linalg.norm([now[f"wheel_{w}.{c}"] - now[f"wheel_{w}.contact_{c}"] for c in "xyz"])
        assert radius == pytest.approx(now[f"wheel_{w}.loaded_radius"], abs=1e-4), w
        moved = (now[f"wheel_{w}.x"] - before[f"wheel_{w}.x"]) / STEP
        assert moved == pytest.approx(now[f"wheel_{w}.earth_vx"], rel=1e-3), w
        assert now[f"wheel_{w}.Mx"] == 0.0
    # a free wheel that rolls evenly: of its Fx and My nothing is left about the axle
    lever = now["wheel_RL.Fx"] * now["wheel_RL.loaded_radius"]
    assert now["wheel_RL.My"] == pytest.approx(lever, abs=0.1 * abs(lever) + 1.0)


def test_a_damper_reports_speed_and_force_without_the_stops() -> None:
    """In a fall that reaches both stops: c times the rate of its length; spring and stops have the rest."""
    rest = simulation(rigid, 0.0, torque="half_shafts").sensors
    s = mbs.Simulation(system(rigid, (("torque", "half_shafts"),)), pose=mbs.Pose(z=0.4))
    names, rows = ("spring_FL.length", "spring_FL.force", "damper_FL.speed", "damper_FL.force"), []
    for _ in range(300):
        s.step(STEP)
        rows.append([s.sensors[name] for name in names])
    length, whole, rate, force = np.array(rows).T
    front = rigid()._data["front"]
    assert force == pytest.approx(front["damper"]["damping"] * rate, rel=1e-12)
    assert 0.5 * (rate[1:] + rate[:-1]) == pytest.approx(np.diff(length) / STEP, abs=0.01 * np.ptp(rate))
    longer = length - rest["spring_FL.length"]
    stops = whole - force - rest["spring_FL.force"] - front["spring"]["stiffness"] * longer
    assert stops.min() < -1000.0
    assert stops.max() > 1000.0
    between = (longer > -front["stops"]["bump_gap"]) & (longer < front["stops"]["rebound_gap"] - 0.003)
    assert between.any()
    assert stops[between] == pytest.approx(0.0, abs=1e-6)


def test_the_sum_of_the_forces_is_the_change_of_the_momentum() -> None:
    """In a turn with drive, brakes, wind and a force: tyres, air and port against mass times the earth velocities."""
    s = simulation(rigid, 15.0, torque="half_shafts", brakes="torque", forces="earth", wind="speed")
    mass = sum(s.sensors[f"wheel_{w}.Fz"] for w in WHEELS) / 9.81
    for name, value in {"steering": 0.1, "wind.speed": 8.0, "wind.heading": 2.0, "point_reference.Fy": 150.0}.items():
        s.set_input(name, value)
    area = 0.5 * rigid()._data["aerodynamics"]["air_density"] * rigid()._data["aerodynamics"]["drag_area"]
    velocities, sums = [], []
    for k in range(500):
        s.set_input("wheel_RL.drive_torque", 100.0 + 60.0 * np.sin(0.01 * k))
        s.set_input("wheel_FR.brake_torque_demand", 60.0)
        s.step(STEP)
        now = s.sensors
        velocity = np.array([now["chassis.earth_vx"], now["chassis.earth_vy"]])
        over = 8.0 * np.array([np.cos(2.0), np.sin(2.0)]) - velocity
        force = np.array([0.0, 150.0]) + area * np.hypot(*over) * over
        for w in WHEELS:
            turn = np.exp(1j * (now["chassis.yaw"] + now[f"wheel_{w}.steer"]))
            tyre = turn * complex(now[f"wheel_{w}.Fx"], now[f"wheel_{w}.Fy"])
            force += [tyre.real, tyre.imag]
        velocities.append(velocity)
        sums.append(force)
    forces, changes = np.array(sums)[100:-1], mass * np.gradient(np.array(velocities), STEP, axis=0)[100:-1]
    assert np.abs(changes).max() > 1000.0
    assert forces == pytest.approx(changes, abs=0.01 * np.abs(changes).max())


def test_a_gear_that_is_asked_for_is_engaged_and_the_drive_shifts_by_itself_without() -> None:
    """Its engine turns as fast as the gear makes it, and the powers on the wheels are those of its torque."""
    plain, ported = simulation(rigid, 15.0), simulation(rigid, 15.0, gear="request")
    for s in (plain, ported):
        s.set_input("throttle", 0.3)
        s.step(STEP, 250)
    now, same = ported.sensors, plain.sensors
    assert all(now[name] == value for name, value in same.items()), "to the last bit without a request"
    assert now["gear"] == 3.0
    ported.set_input("gear_request", 2.0)
    ported.step(STEP, 250)
    now, other = ported.sensors, plain.sensors
    assert now["gear"] == now["used.gear_request"] == 2.0
    assert now["engine_speed"] > 1.2 * other["engine_speed"]
    w = rigid().drive.wheels[0].upper()
    for side in "LR":
        power = now[f"wheel_{w}{side}.drive_torque"] * now[f"wheel_{w}{side}.omega"]
        assert now[f"wheel_{w}{side}.drive_power"] == pytest.approx(power, rel=0.02)
    inputs, sensors = names(rigid())
    mine, observation = names(with_ports(rigid(), gear="request"))
    assert [n for n in mine if n != "gear_request"] == inputs
    assert [n for n in observation if n in sensors] == sensors


@pytest.mark.slow
def test_a_clutch_transmits_the_torque_of_its_pedal() -> None:
    """Released it changes no bit; pressed the car rolls as in neutral; between it has the torque that is left."""
    plain, ported = simulation(rigid, 3.0), simulation(rigid, 3.0, clutch="pedal")
    for s in (plain, ported):
        s.set_input("throttle", 1.0)
        s.step(STEP, 200)
    same = plain.sensors
    assert all(ported.sensors[name] == value for name, value in same.items())
    drive = rigid().drive
    assert drive.kind == "automatic"
    most = drive.ratios[0] * drive.efficiency * drive.stall_factor * drive.max_torque + 2.0 * drive.creep_torque
    ported.set_input("clutch", 0.8)
    ported.step(STEP, 200)
    now = ported.sensors
    assert (now["gear"], now["used.clutch"]) == (1.0, 0.8)
    assert 2.0 * now["drive_torque"] == pytest.approx(0.2 * most, rel=1e-12)
    assert now["engine_speed"] > same["engine_speed"]
    ported.set_input("clutch", 1.0)
    ported.step(STEP)
    work = ported.sensors["energy.drive"]
    ported.step(STEP, 250)
    assert ported.sensors["energy.drive"] == work
    ported.set_input("clutch", 0.0)
    ported.step(STEP, 50)
    assert ported.sensors["drive_torque"] > 0.1 * most
    # closed throttle brakes with the engine; in neutral and with an open clutch nothing does, from 0.3 s on
    lost = []
    for inputs in ({"selector": 0.0}, {"clutch": 1.0}, {}):
        s = simulation(rigid, 15.0, clutch="pedal")
        for name, value in inputs.items():
            s.set_input(name, value)
        s.step(STEP, 250)
        before = s.sensors["speed"]
        s.step(STEP, 500)
        lost.append(before - s.sensors["speed"])
    assert lost[1] == pytest.approx(lost[0], rel=0.01)
    assert lost[2] > 1.2 * lost[0]


def test_ports_that_do_not_fit_are_one_sentence() -> None:
    cases = {
        "torque": lambda: with_ports(rigid(), torque="axles"),
        "full_pressure": lambda: with_ports(rigid(), brakes="pressure", full_pressure=100.0),
        "rack_force": lambda: with_ports(rigid(), steering="rack_force"),
        "rack_position": lambda: with_ports(column_car(), steering="rack_position"),
        "an electric drive has none": lambda: with_ports(hatchback(), gear="request"),
        "ports.clutch opens the clutch of an automatic drive, and an electric drive has none": lambda: with_ports(
            hatchback(), clutch="pedal"
        ),
        "leaves the drive out": lambda: with_ports(rigid(), gear="request", torque="half_shafts"),
    }
    for word, make in cases.items():
        with pytest.raises(CarFileError, match=word):
            make()
    assert chosen_ports("torque, brakes=pressure") == {"torque": "half_shafts", "brakes": "pressure"}
    for text in ("", "tyres", "torque=axle", "torque,torque=hub_motors", "brakes="):
        with pytest.raises(ValueError, match=r"torque \(half_shafts or hub_motors\)"):
            chosen_ports(text)
