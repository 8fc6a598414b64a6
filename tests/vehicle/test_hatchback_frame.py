"""The frame of the hatchback: size and stiffness, equilibrium, kerb, and what meshes and steps leave open."""

import shutil
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from benchmarks.car.frame_stiffness import stiffness
from mbs import Simulation, System, compile
from mbs.common.errors import ModelError
from mbs.shapes.pose_outputs import pose_outputs
from mbs.vehicle import CarFileError, CarWarning, Fidelity, load
from mbs.vehicle.car import Car
from tests.scene_numbers import amplitudes, rows_of_stress, stress

WHEELS = ("FL", "FR", "RL", "RR")
GAUGES = ("SG1", "SG2", "SG3", "SG4", "SG5", "SG6")
FLEXIBLE = (1, 2, 3)


@cache
def car() -> Car:
    return load("hatchback")


@cache
def system(fidelity: int) -> System:
    return compile(car().model(fidelity=fidelity))


def test_the_frame_is_the_rigid_chassis_in_mass_centre_and_inertia() -> None:
    mass, chassis = car().flexible_frame.model.mass, car().chassis
    total = mass.masses.sum()
    assert total == pytest.approx(chassis.mass, abs=0.01)
    np.testing.assert_allclose(mass.masses @ mass.positions / total, chassis.com, rtol=0, atol=1e-5)
    arms = mass.positions - np.array(chassis.com)
    second = (mass.masses[:, None] * arms).T @ arms
    np.testing.assert_allclose(np.trace(second) * np.eye(3) - second, chassis.tensor, rtol=0, atol=0.05)


def test_it_is_as_stiff_as_bodies_of_the_class() -> None:
    actual = stiffness(car())
    assert actual.joints == ("STL", "DTL")
    assert 12e3 < actual.torsion < 25e3
    assert actual.torsion == pytest.approx(24.7e3, abs=50.0)
    np.testing.assert_allclose(actual.frequencies, [27.6, 28.3, 38.9, 40.9], rtol=0, atol=0.06)


@pytest.mark.slow
def test_every_fidelity_stands_as_drawn_and_reads_the_same_stresses() -> None:
    assert list(car().fidelities()) == [Fidelity.RIGID, Fidelity.QUASI_STATIC, Fidelity.LOAD_PATHS, Fidelity.DYNAMIC]
    rest = {fidelity: Simulation(system(fidelity)).sensors for fidelity in (0, *FLEXIBLE)}
    for fidelity in FLEXIBLE:
        for wheel in WHEELS:
            assert rest[fidelity][f"wheel_{wheel}.Fz"] == pytest.approx(rest[0][f"wheel_{wheel}.Fz"], rel=2e-4)
        for gauge in GAUGES:
            expected = rest[1][f"stress.{gauge}"]
            assert abs(expected) > 1e6
            assert rest[fidelity][f"stress.{gauge}"] == pytest.approx(expected, rel=3e-3)
            assert rest[0][f"stress.{gauge}"] == pytest.approx(expected, rel=1e-3)


def test_all_forces_on_the_chassis_enter_by_its_ports() -> None:
    """Weight and no moment about its centre of mass: the bars twist under a load on one side, and their levers give
    the chassis the forces of their bushes, no torque past the ports.
    """
    simulation = Simulation(system(1), parameters={"payload.rear_left.mass": 200.0})
    names = [row["name"] for row in simulation.system.meta["rows"]]
    lam = simulation.state.lam * simulation.system.arrays["row_scale"]
    interfaces, chassis = car().flexible_frame.joints.interfaces, car().chassis
    force = {j: lam[[k for k, row in enumerate(names) if row == f"chassis.{j}"]] for j in interfaces}
    weight = 9.81 * chassis.mass
    np.testing.assert_allclose(sum(force.values()), (0.0, 0.0, weight), rtol=0, atol=1e-6 * weight)
    roll, pitch = (simulation.sensors[f"chassis.{angle}"] for angle in ("roll", "pitch"))
    assert max(abs(roll), abs(pitch)) > 0.002
    q = np.array([simulation.sensors[f"chassis.q{c}"] for c in "wxyz"])
    w, v = q[0], q[1:]

    def turned(x: np.ndarray) -> np.ndarray:
        return np.asarray(x + 2.0 * np.cross(v, np.cross(v, x) + w * x))

    moment = sum(np.cross(turned(np.subtract(place, chassis.com)), force[j]) for j, place in interfaces.items())
    np.testing.assert_allclose(moment, 0.0, rtol=0, atol=1e-5 * weight)


@pytest.mark.slow
def test_the_energy_of_the_car_is_that_of_its_works_and_the_frame_only_loses() -> None:
    """Damping of the frame is no work of the list; it is a small part of what the tyres and dampers take."""
    run = Simulation(system(3)).run(3.0, 0.001, inputs={"throttle": 0.6, "steering": 0.2})
    works = sum(run[f"energy.{name}"] for name in ("drive", "brakes", "tyres", "dampers", "drag", "ground"))
    residual = run["energy.total"] - run["energy.total"][0] - works
    assert run["energy.drive"][-1] > 2e4
    assert np.abs(residual).max() < 2e-3 * run["energy.drive"][-1]


@pytest.mark.slow
def test_the_scene_gives_the_gauges() -> None:
    """Gauges of sill, rail and cross member from the rows of stress and the amplitudes alone, and from the weight
    that the element carries between its ends, 18 to 20 kPa; its inertia in the turn is up to 2.1e-4 of a gauge more.
    """
    model = car().model(fidelity=3)
    pose_outputs(model)
    (part,) = model.flexible_scene
    inputs = {"steering": 0.4, "throttle": 0.7}
    run = Simulation(compile(model)).run(2.0, 0.01, inputs=inputs, estimate_error=False)
    eta = amplitudes(part, run)
    tubular = car().frame_section.tubular(car().folder)
    frame, tubes = tubular.frame()
    for gauge in tubular.strain_gauges(tubes):
        ends = rows_of_stress(part, eta)[:, gauge.element]
        axial, about_y, about_z = np.moveaxis((1.0 - gauge.xi) * ends[:, 0] + gauge.xi * ends[:, 1], -1, 0)
        assert gauge.fibre is not None
        y, z = np.array(gauge.fibre) / np.hypot(*gauge.fibre)
        bending = z * about_y - y * about_z
        beam = frame.beams[gauge.element]
        length, axes = frame.element_axes(gauge.element)
        up = beam.material.rho * beam.section.area * 9.81 * axes[:, 2]
        moment = 0.5 * gauge.xi * (1.0 - gauge.xi) * length**2 * (y * up[1] + z * up[2])
        carried = moment * np.hypot(*gauge.fibre) / beam.section.Iy
        actual = axial + bending - carried if gauge.name in ("SG5", "SG6") else 2.0 * (bending - carried)
        expected = run[f"stress.{gauge.name}"]
        largest = np.abs(expected).max()
        assert largest > 1e6
        np.testing.assert_allclose(actual, expected, rtol=0, atol=3e-4 * largest, err_msg=gauge.name)
    assert stress(part, eta[:1]).max() < part["stress"]["range"] < part["stress"]["limit"]  # of the standing car


@pytest.mark.slow
def test_a_hatchback_that_its_frame_does_not_fit_is_rigid_as_without_a_frame() -> None:
    """It says why; a file of the user's is loaded with a warning."""
    change = {"front.suspension.points.strut_top": [-0.045, 0.545, 0.83]}
    message = "where the frame has no joint"
    changed = car().changed(change)
    assert list(changed.fidelities()) == [Fidelity.RIGID]
    with pytest.raises(ModelError, match=rf"has fidelity 0 only: its frame does not fit it\. .*{message}"):
        changed.model(fidelity=1)
    names = [sensor.name for sensor in changed.model().sensors]
    assert not [name for name in names if name.startswith("stress.")]
    with pytest.raises(CarFileError, match=message):
        car().changed({**change, "chassis.frame.or_rigid": False})


def test_a_file_whose_frame_does_not_fit_warns(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(car().folder, tmp_path / "car"))
    file = folder / "car.toml"
    text = file.read_text(encoding="utf-8")
    assert text.count("strut_top = [-0.0400,") == 1
    file.write_text(text.replace("strut_top = [-0.0400,", "strut_top = [-0.0380,"), encoding="utf-8")
    with pytest.warns(CarWarning, match="fidelity 0 only, the frame does not fit the car"):
        assert list(load(folder).fidelities()) == [Fidelity.RIGID]
