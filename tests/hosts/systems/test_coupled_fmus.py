"""Coupled FMUs: cars with copies of their parts converge to the car alone; invalid systems are refused."""

import math
import os
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import mbs
from hosts.common.errors import HostError
from hosts.fmu.fmu import StepRefusedError
from hosts.systems import CoupledFmus, write_ssp
from tests.hosts.systems import controlled, trailer, weak_coupling
from tests.hosts.systems.controlled import SYSTEMS, run
from tests.hosts.systems.masters import MASTERS
from tests.hosts.systems.on_off import BRAKING_DISTANCE, SHORT, braking_distance, distance_with_shifts, error
from tests.hosts.systems.twins import twin
from tests.hosts.systems.weak_coupling import CASES, car_fmu, coupled, parts_of, start_of
from tests.quick import quick

# one part and several, controllers in Python: each way to wire a system by one of the other masters
BY_OTHERS = {
    ("libcosim", "drive"), ("libcosim", "brakes on split friction"), ("Ecos", "trailer"), ("Ecos", "yaw control"),
}  # fmt: skip
WIRES = {"spring.position": "mass.position", "mass.force": "spring.force"}


def oscillate(partners: dict[str, Path], step: float, order: str) -> tuple[np.ndarray, list[str]]:
    parts = {"mass": partners["half_mass"], "spring": partners["half_spring"]}
    with CoupledFmus(parts, WIRES, step=step, order=order) as system:
        system.initialise(**{"mass.start": 1.0})
        return system.run(1.0, ("mass.position", "spring.force")), system.messages


def test_an_oscillator_of_two_fmus_is_the_scheme_that_its_order_makes(partners):
    """Mass and spring in turn are the symplectic Euler method, at once a later one; both by their own recurrences."""
    h = 0.05
    for order in ("in turn", "at once"):
        rows, messages = oscillate(partners, h, order)
        x, v, force = 1.0, 0.0, -1.0
        for k in range(20):
            last_force = force
            force = -x if order == "at once" else force
            v += h * last_force
            x += h * v
            force = -x if order == "in turn" else force
            assert rows[k + 1, 0] == pytest.approx(x, rel=1e-12), (order, k)
        assert not messages
    errors = [abs(oscillate(partners, h, "in turn")[0][-1, 0] - math.cos(1.0)) for h in (0.05, 0.025)]
    assert 1.8 < errors[0] / errors[1] < 2.2


def test_a_nan_is_reported_once_with_its_part(partners):
    parts = {"mass": partners["half_mass"], "spring": partners["half_spring"]}
    with CoupledFmus(parts, WIRES, step=0.1) as system:
        system.initialise(**{"mass.start": 1.0, "spring.break_at": 0.25})
        system.run(0.5, ("mass.position",))
        messages = [m for m in system.messages if "spring: at" in m]
        assert messages == ["spring: at 0.3 s 'force' is nan. This is reported once."]


@pytest.mark.parametrize(("first", "slopes"), [("source", [10.0, 0.0, 0.0]), ("sink", [0.0, 10.0, 0.0])])
def test_a_followed_source_that_jumps_and_stays(partners, first, slopes):
    """0, 1, 1, 1: what is known at the end is met there; else the step before is gone on with."""
    parts = {"source": partners["jump"], "sink": partners["half_spring"]}
    with CoupledFmus(
        {first: parts[first], **parts}, {"sink.position": "source.value"}, step=0.1, inputs="followed"
    ) as system:
        results: list[float] = []
        sink = next(p for p in system._parts if p.name == "sink")
        sink.set_slopes = lambda given: results.extend(given)  # PythonFMU's FMUs take no derivatives
        for _ in range(2):  # a second start does not go on with the run before
            system.initialise()
            system.run(0.3, ("source.value",))
            assert results == pytest.approx(slopes)
            results.clear()


REFUSED = {"source.refuse_from": 0.15}
CHAIN = {"mass.force": "source.value"}


def test_after_a_refused_step_all_parts_are_where_they_were(partners):
    parts = {"mass": partners["half_mass"], "source": partners["jump"]}
    with CoupledFmus(parts, CHAIN, step=0.1) as system:
        system.initialise()
        undisturbed = system.run(0.3, ("mass.position",))
        system.initialise(**REFUSED)
        system.run(0.2, ("mass.position",))
        before = system.read(("mass.position", "source.value"))
        message = r"The part 'source' refused the step from 0.2 s: .* All parts are back at 0.2 s\."
        with pytest.raises(StepRefusedError, match=message):
            system.step()
        assert list(system.read(("mass.position", "source.value"))) == list(before)
        system.fmu("source").setter(["given"])([1.0])
        system.step()
        assert system.time == pytest.approx(0.3)
        assert system.read(("mass.position",)) == undisturbed[-1]


def test_a_system_that_cannot_repeat_a_step_reports_it_and_restarts(partners):
    parts = {"mass": partners["half_mass"], "source": partners["stateless"]}
    with CoupledFmus(parts, CHAIN, step=0.1) as system:
        with pytest.raises(HostError, match="must be initialised before a step"):
            system.step()
        system.initialise(**REFUSED)
        one = system.run(0.2, ("mass.position",))
        with pytest.raises(StepRefusedError, match="cannot continue, because the part 'source' cannot save its state"):
            system.step()
        with pytest.raises(HostError, match="again after one that only some parts made"):
            system.step()
        system.initialise(**REFUSED)
        assert system.run(0.2, ("mass.position",)).tolist() == one.tolist()


def test_states_are_freed_where_a_later_part_cannot_save_its_own(partners, monkeypatch):
    parts = {"mass": partners["half_mass"], "source": partners["jump"]}
    with CoupledFmus(parts, CHAIN, step=0.1, inputs="repeated") as system:
        system.initialise()
        freed: list[object] = []
        free = system.fmu("mass").free
        monkeypatch.setattr(system.fmu("mass"), "free", lambda state: (freed.append(state), free(state)))
        monkeypatch.setattr(system.fmu("source"), "state", lambda: (_ for _ in ()).throw(HostError("no memory")))
        with pytest.raises(HostError, match="no memory"):
            system.step()
        assert len(freed) == 1


def test_what_a_system_cannot_do_is_one_sentence(partners):
    """Not after it is closed either, where the library of the FMU is gone."""
    parts = {"mass": partners["half_mass"], "spring": partners["half_spring"]}
    with CoupledFmus(parts, WIRES, step=0.1) as system:
        for act, message in (
            (lambda: system.read(["mass.position"]), "must be initialised before its values are read"),
            (lambda: system.initialise(**{"mas.start": 1.0}), "'mas.start' names no part; did you mean 'mass'"),
            (lambda: system.initialise(**{"mass.start": "a"}), "The part 'mass': 'start' is 'a'; it must be a Real"),
            (lambda: system.initialise(mass=1.0), "'mass' names a part and no variable"),
            (
                lambda: system.initialise(**{"mass.start": [1.0]}),
                r"'start' is \[1.0\]; only finite numbers can be used",
            ),
            (lambda: system.fmu(1), "There is no part 1"),
            (lambda: system.fmu("sprin"), "There is no part 'sprin'; did you mean 'spring'"),
        ):
            with pytest.raises(HostError, match=message):
                act()
        system.initialise()
        with pytest.raises(HostError, match="The part 'mass' has no number 'positio'; did you mean 'position'"):
            system.read(["mass.positio"])
        for names, message in (("mass.position", "The variables are 'mass.position'"), ([1], "have 1 among them")):
            with pytest.raises(HostError, match=message):
                system.read(names)
        for duration in (0.25, -0.1, math.nan, "1"):
            with pytest.raises(HostError, match=rf"A run of {duration!r} s is .* it must be a whole number of them"):
                system.run(duration, ["mass.position"])
        assert len(system.run(0.3, ["mass.position"])) == 4
    for act in (system.step, system.initialise, lambda: system.read(["mass.position"]), lambda: system.fmu("mass")):
        with pytest.raises(HostError, match="The system is closed; make another one"):
            act()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"step": "0.01"}, r"The communication step is '0.01'; it must be a positive number, in s\."),
        ({"parts": ["mass"]}, r"The parts of a system are \['mass'\]; they must be a dictionary"),
        ({"parts": {"mass": None}}, "The part 'mass' is None; it must be the path of an FMU"),
        ({"parts": {1: "mass.fmu"}}, "The names of the parts of a system have 1 among them"),
        ({"connections": "spring.force"}, "The connections are 'spring.force'; they must be a dictionary"),
    ],
)
def test_options_of_another_type_are_refused_in_one_sentence(partners, options, message):
    usual = {"parts": {"mass": partners["half_mass"]}, "connections": {}, "step": 0.1}
    with pytest.raises(HostError, match=message):
        CoupledFmus(**(usual | options))


def test_an_angle_is_no_plain_number(partners, scene_fmu):
    """Nor is what an FMU that tells no unit has, which passes."""
    sledge = scene_fmu(f"{Path(__file__).parents[1] / 'scenes.py'}:sledge")
    parts = {"sledge": sledge, "mass": partners["half_mass"]}
    CoupledFmus(parts, {"sledge.steering": "mass.position", "mass.force": "sledge.chassis.yaw"}, step=0.1).close()
    with pytest.raises(HostError, match=r"'sledge.chassis.yaw' is in rad and 'sledge.steering' in 1; a wire converts"):
        CoupledFmus(parts, {"sledge.steering": "sledge.chassis.yaw"}, step=0.1)


@pytest.mark.parametrize(
    ("wires", "message"),
    [
        ({"spring": "mass.position"}, "'spring' names a part and no variable"),
        ({"spring.position": "car.x"}, "'car.x' names no part"),
        ({"spring.place": "mass.position"}, "The part 'spring' has no input 'place'"),
        ({"spring.position": "mass.force"}, "The part 'mass' has no output 'force'"),
    ],
)
def test_invalid_wires_are_refused(partners, wires, message):
    parts = {"mass": partners["half_mass"], "spring": partners["half_spring"]}
    with pytest.raises(HostError, match=message):
        CoupledFmus(parts, wires, step=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("drive",), CASES, "proof"))
def test_a_car_wired_to_a_copy_of_its_part_converges_to_the_closed_car(name):
    """At 2 ms: wheel loads within 1 %, the path within 0.2 %; repeated steps halve the error or better."""
    load, path, messages = coupled(name, 0.002)
    assert load < 1e-2
    assert path < 2e-3
    assert not messages
    again, path_again, _ = coupled(name, 0.002, inputs="repeated")
    assert again < 0.5 * load
    assert path_again < 0.5 * path
    rate = coupled(name, 0.004)[0] / load
    assert (10.0 if name == "road" else 1.5) < rate < (13.0 if name == "road" else 2.4), "planes: of order three"


@pytest.mark.proof
@pytest.mark.parametrize("name", ["yaw control", "torque vectoring", "two cars"])
def test_repeated_steps_halve_the_error_of_a_controller_that_does_not_switch(name):
    """Against the same as one."""
    held, again = (run(name, 0.004, inputs=inputs)[SYSTEMS[name].measure][-1] for inputs in ("held", "repeated"))
    assert abs(again - twin(name)[-1]) < 0.5 * abs(held - twin(name)[-1])


@pytest.mark.slow
def test_a_switching_law_is_late_by_a_step_for_all_kinds_of_inputs():
    """Against steps of 0.1 ms: held inputs are the nearer the shorter the step, others are not nearer."""
    held = [error(h, "held") for h in (0.002, 0.01)]
    assert held[0] < held[1] < 1e-2
    assert error(0.002, "repeated") > 0.5 * held[0]
    assert error(0.01, "followed") > 0.5 * held[1]


@pytest.mark.proof
def test_the_stored_distance_is_that_of_steps_of_a_tenth_of_a_millisecond():
    assert braking_distance(SHORT) == pytest.approx(BRAKING_DISTANCE, rel=1e-6)
    assert 20.0 < BRAKING_DISTANCE < 23.0, "it would coast 30 m"


@pytest.mark.slow
def test_gears_requested_by_another_program_are_held_for_all_kinds_of_inputs():
    """A whole number has no derivative."""
    assert 1e-6 < abs(distance_with_shifts(0.01) / distance_with_shifts(0.002) - 1.0) < 2e-3
    assert (
        distance_with_shifts(0.01, "followed") == distance_with_shifts(0.01, "repeated") == distance_with_shifts(0.01)
    )


@pytest.mark.slow
def test_a_silent_partner_or_one_that_gives_nan_is_reported(partners):
    """Three ports that nobody sets, and one whose partner breaks: it holds the last value, and the car drives on."""
    parts = {"car": car_fmu("prototype", "torque"), "spring": partners["half_spring"]}
    wires = {"spring.position": "car.chassis.x", "car.wheel_RL.drive_torque": "spring.force"}
    with CoupledFmus(parts, wires, step=0.01) as system:
        system.initialise(**{"car.initial.speed": 5.0, "spring.break_at": 0.205})
        rows = system.run(0.5, ("car.used.wheel_RL.drive_torque", "car.chassis.x"))
        messages = " ".join(system.messages)
    for message in ("3 ports were not set", "'wheel_RL.drive_torque' was set to nan and holds", "'force' is nan"):
        assert messages.count(message) == 1, system.messages
    assert np.isfinite(rows).all()
    assert np.ptp(rows[25:, 0]) == 0.0
    assert np.ptp(rows[:20, 0]) > 0.1


@pytest.mark.slow
def test_repeated_steps_that_diverge_at_a_stiff_hitch_are_reported():
    """At 10 ms each pass makes the force of the ball larger: it ends at the range of the ports, which is said."""
    load, _, messages = coupled("trailer", 0.01, inputs="repeated")
    assert load > 0.01
    assert [m for m in messages if m.startswith("car: 'point_hitch.F") and "end of its range" in m]
    assert len(messages) == len(set(messages))
    assert coupled("trailer", 0.01, inputs="followed")[0] < 1e-4


@pytest.mark.slow
def test_planes_of_a_road_that_is_stepped_before_the_car_go_from_answer_to_answer(monkeypatch):
    """Behind the car they go on as in the last step, 3 % off, which is told."""
    load, _, messages = coupled("road", 0.01, inputs="followed")
    assert load < 5e-3
    assert not messages
    monkeypatch.setattr(weak_coupling, "parts_of", lambda name, _="held": parts_of(name))
    load, _, messages = coupled("road", 0.01, inputs="followed")
    assert load > 2e-2
    assert any("the last one was off by" in text for text in messages)


@pytest.mark.slow
def test_as_one_model_car_and_trailer_start_as_each_stands_alone():
    pose = mbs.Pose(speed=10.0)
    whole = mbs.Simulation(trailer.with_trailer(), pose=pose).sensors
    for model in (trailer.car_with_hitch().model(), trailer.trailer()):
        alone = mbs.Simulation(mbs.compile(model), pose=pose).sensors
        same = [n for n in alone if n.startswith(("wheel_", "load_", "hitch.", "point_hitch."))]
        assert len(same) > 7
        # at rest the angle at the hitch is free: 1.2e-7 rad
        assert [whole[n] for n in same] == pytest.approx([alone[n] for n in same], rel=1e-9, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("master", "name"), quick(BY_OTHERS, product(MASTERS, (*CASES, *SYSTEMS)), "proof"))
def test_other_masters_run_the_ssp_as_the_own_one_does(name, master, tmp_path):
    """They step all at once; to round-off, as libcosim counts its time in nanoseconds."""
    step, count = 0.004, 60
    if name in CASES:
        parts, wires, start = parts_of(name), CASES[name].wires, start_of(name)
    else:
        parts, wires, start = controlled.parts_of(SYSTEMS[name]), SYSTEMS[name].wires, controlled.start_of(name)
    names = ("chassis.x", "chassis.y", "chassis.wz", "speed")
    ssp = write_ssp(tmp_path / "system.ssp", parts, wires, start)
    actual = MASTERS[master](ssp, Path(parts["car"]), step, count, names)
    with CoupledFmus(parts, wires, step=step, order="at once") as system:
        system.initialise(**start)
        before = system.read([f"car.{n}" for n in names])
        for _ in range(count):
            system.step()
        own = system.read([f"car.{n}" for n in names])
    assert actual == pytest.approx(own, rel=1e-9, abs=1e-11)
    assert own[0] > before[0] + 2.0


@pytest.mark.slow
def test_on_split_friction_the_car_is_steered_while_it_brakes():
    """With locked wheels it turns round."""
    free, locked = (run("brakes on split friction", 0.004, on=on) for on in (True, False))
    assert free["car.speed"][-1] < 0.1
    assert locked["car.speed"][-1] < 0.5
    assert np.abs(free["car.chassis.yaw"]).max() < 0.15
    assert np.abs(free["car.chassis.y"]).max() < 0.5
    assert np.abs(locked["car.chassis.yaw"]).max() > 1.5
    assert np.ptp(free["car.chassis.x"]) < 0.95 * np.ptp(locked["car.chassis.x"])


@pytest.mark.slow
def test_yaw_control_passes_the_sine_with_dwell_in_which_the_car_spins():
    """Limits of FMVSS 126: yaw rate over its peak 35 % and 20 % 1 and 1.75 s after the steering; 1.83 m aside."""
    end = 0.5 + 1.0 / 0.7 + 0.5
    yaw_rates = []
    for on in (True, False):
        columns = run("yaw control", 0.004, on=on)
        times = 0.004 * np.arange(len(columns["car.chassis.wz"]))
        peak = columns["car.chassis.wz"][(times > 1.0) & (times < end)].min()
        yaw_rates.append([np.interp(end + late, times, columns["car.chassis.wz"]) / peak for late in (1.0, 1.75)])
        assert np.interp(0.5 + 1.07, times, columns["car.chassis.y"]) > 1.83
    assert abs(yaw_rates[0][0]) < 0.35
    assert abs(yaw_rates[0][1]) < 0.20
    assert min(yaw_rates[1]) > 0.5, "without control it does not stop turning"


@pytest.mark.slow
def test_torque_vectoring_turns_the_car_more():
    """Towards the yaw rate that is wanted, 12 m/s * 0.125 rad / (1.68 m + 0.0015 s2/m (12 m/s)2) = 0.79 rad/s."""
    rates = [float(run("torque vectoring", 0.004, on=on)["car.chassis.wz"][-1]) for on in (False, True)]
    assert 1.05 * rates[0] < rates[1] < 0.79


@pytest.mark.slow
def test_the_car_behind_keeps_its_distance_when_the_one_ahead_brakes():
    columns = run("two cars", 0.01)
    assert columns["ahead.speed"][-1] < 8.0
    assert columns["controller.gap"].min() > 8.0
    expected = 5.0 + 1.2 * columns["car.speed"][-1]
    assert columns["controller.gap"][-1] == pytest.approx(expected, abs=2.0)


@pytest.mark.slow
def test_the_code_of_the_page_stops_at_its_stated_position(tmp_path):
    root = Path(__file__).parents[3]
    page = (root / "docs" / "systems.md").read_text(encoding="utf-8")
    code = page.split("```python\n")[1].split("```")[0]
    (tmp_path / "dist").mkdir()
    (tmp_path / "examples").symlink_to(root / "examples")
    environment = os.environ | {"PYTHONPATH": str(root)}
    command = [sys.executable, "-c", code]
    completed = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert completed.returncode == 0, completed.stderr[-2000:]
    distance = completed.stdout.split("stands after ")[1].split(" m")[0]
    assert f"The car stops after {distance} m" in page
    assert (tmp_path / "dist" / "anti_lock_brakes.ssp").is_file()
