"""Systems of cars and controllers as one: in each step the laws hold at its end, as the forces of the cars do."""

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from pythonfmu import Fmi2Slave

import mbs
from hosts.systems.coupled_fmus import INPUTS
from mbs.vehicle.ports import chosen_ports
from tests.hosts.systems.controlled import CONTROLLERS, INNER, SYSTEMS, run, start_of
from tests.hosts.systems.weak_coupling import percent
from tests.modules import module_of
from tests.vehicle.cars_with_ports import rigid, with_ports

ROUNDS = 30  # of a step at most
NEAR = 1e-9  # share of an output's size, at which a round is the last
Values = dict[str, float]


class _Car:
    """A car of a system, whose steps can be made again."""

    def __init__(self, ports: str, start: dict[str, Any]) -> None:
        data = with_ports(rigid(), **chosen_ports(ports)) if ports else rigid()
        system = mbs.compile(data.model())
        self.names = [entry["name"] for entry in system.meta["inputs"]]
        pose = {n.removeprefix("initial."): x for n, x in start.items() if n.startswith("initial.")}
        inputs = {n: x for n, x in start.items() if n in self.names}
        parameters = {n: x for n, x in start.items() if n not in self.names and not n.startswith("initial.")}
        self.car = mbs.Simulation(system, pose=mbs.Pose(**pose), inputs=inputs, parameters=parameters)

    def read(self) -> Values:
        return self.car.sensors

    def give(self, inputs: Values) -> None:
        for name, value in inputs.items():
            self.car.set_input(name, value)

    def save(self) -> bytes:
        return self.car.save()

    def step(self, state: bytes, inputs: Values, time: float, h: float) -> None:
        """Step from a state with inputs that change linearly to those at the end."""
        self.car.restore(state)
        row = [inputs.get(name, self.car.instance.get_input(i)) for i, name in enumerate(self.names)]
        self.car.instance.run(h, 1, np.array(row))


class _Law:
    """A controller or a driver as an object of Python, without an FMU."""

    def __init__(self, file: str, start: dict[str, Any]) -> None:
        module = module_of(CONTROLLERS / f"{file}.py")
        (kind,) = (
            c for c in vars(module).values() if isinstance(c, type) and issubclass(c, Fmi2Slave) and c != Fmi2Slave
        )
        self.slave = kind(instance_name=file)
        self.names = [v.name for v in self.slave.vars.values()]
        self.give(start)

    def read(self) -> Values:
        return {name: getattr(self.slave, name) for name in self.names}

    def give(self, inputs: Values) -> None:
        for name, value in inputs.items():
            setattr(self.slave, name, value)

    def save(self) -> Values:
        return self.read()

    def step(self, state: Values, inputs: Values, time: float, h: float) -> None:
        """Step from a state with the inputs at the end."""
        self.give(state | inputs)
        self.slave.do_step(time, h)


@cache
def twin(name: str, h: float = INNER) -> np.ndarray:
    """What `SYSTEMS` measures, at every step of a system as one."""
    case = SYSTEMS[name]
    starts: dict[str, dict[str, Any]] = {}
    for text, value in start_of(name).items():
        part, _, variable = text.partition(".")
        if variable != "step_size":
            starts.setdefault(part, {})[variable] = value
    parts: dict[str, _Car | _Law] = {p: _Law(f, starts.get(p, {})) for p, f in case.sources.items()}
    parts |= {p: _Car(ports, starts.get(p, {})) for p, ports in case.cars.items()}
    parts |= {p: _Law(f, starts.get(p, {})) for p, f in case.controllers.items()}
    ends = [(source.partition("."), target.partition(".")) for target, source in case.wires.items()]

    def outputs(of: str) -> Values:
        values = parts[of].read()
        return {f"{part}.{name}": values[name] for (part, _, name), _ in ends if part == of}

    def inputs(of: str, now: Values) -> Values:
        return {name: now["".join(source)] for source, (part, _, name) in ends if part == of}

    now: Values = {}
    for part in parts:
        now |= outputs(part)
    for part, each in parts.items():
        each.give(inputs(part, now))
        if isinstance(each, _Law):
            each.slave.exit_initialization_mode()
            now |= outputs(part)
    for part, each in parts.items():
        each.give(inputs(part, now))
    part, _, measured = case.measure.partition(".")
    rows = [parts[part].read()[measured]]
    for k in range(round(case.time / h)):
        states = {p: each.save() for p, each in parts.items()}
        for _ in range(ROUNDS):
            before = dict(now)
            for p, each in parts.items():
                each.step(states[p], inputs(p, now), k * h, h)
                now |= outputs(p)
            if all(abs(now[n] - before[n]) <= NEAR * max(1.0, abs(now[n])) for n in now):
                break
        rows.append(parts[part].read()[measured])
    return np.array(rows)


def lines() -> Iterator[str]:
    """The table of how far the measure at the end is from that of the system as one, in parts of its change."""
    steps = (INNER, 0.002, 0.004, 0.01)
    yield "| system | measured at the end | " + " | ".join(f"{1e3 * h:g} ms" for h in steps) + " |"
    yield "| --- | --- |" + " --- |" * len(steps)
    for name, case in SYSTEMS.items():
        whole = twin(name)
        for inputs in INPUTS:
            ends = [run(name, h, inputs=inputs)[case.measure][-1] for h in steps]
            errors = [percent(abs(end - whole[-1]) / np.ptp(whole)) for end in ends]
            yield f"| {name}, {inputs} | `{case.measure}` | {' | '.join(errors)} |"
