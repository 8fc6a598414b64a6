"""Tables of the FMU variables of the cars of the package."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import mbs
from ali3.message_text import range_text
from fmu_src.variables.text_variables import text_table
from fmu_src.variables.variables import Variable, variable_table
from hosts.common.wheels import WHEELS
from mbs.vehicle import car_names, load

_WHEEL = re.compile(r"_(FL|FR|RL|RR)(?=\.|$)")
_TITLES = {"input": "inputs", "parameter": "parameters", "output": "outputs", "local": "constants"}


@dataclass(frozen=True)
class MergedVariable:
    """A variable of some of the cars; the variables of four wheels, or of both axles, are one."""

    name: str
    """Name of the first of them."""
    names: Sequence[str]
    variable: Variable
    """Variable of the first car that has it."""
    starts: Mapping[str, list[float]]
    """Start values by car."""

    @property
    def cars(self) -> list[str]:
        """The cars that have the variable."""
        return list(self.starts)


def tables(cars: Sequence[str] | None = None) -> dict[str, tuple[Variable, ...]]:
    """Tables of variables by car. `cars`: names, by default all of the package, the prototype first."""
    names = sorted(car_names(), key=lambda n: (n != "prototype", n)) if cars is None else cars
    return {name: _table(name) for name in names}


def merge_variables(tables: Mapping[str, Sequence[Variable]]) -> list[MergedVariable]:
    """Variables of all cars in the order of the first car, merged over wheels and axles."""
    merged: dict[tuple[str, str, str], MergedVariable] = {}
    for car, table in tables.items():
        names = {v.name for v in table}
        counts = Counter(_similar_name(v) for v in table)
        for v in table:
            family = (
                _similar_name(v)
                if v.causality == "parameter" and counts[_similar_name(v)] > 1
                else _common_name(v, names)
            )
            is_single_output = v.causality == "output" and not _WHEEL.search(v.name)
            description = v.description if is_single_output else ""  # cars differ: driven wheels, gear
            key = (v.causality, family, description)
            merged_variable = merged.setdefault(key, MergedVariable(v.name, [], v, {}))
            starts = {
                **merged_variable.starts,
                car: [*merged_variable.starts.get(car, []), *([] if v.start is None else [v.start])],
            }
            merged[key] = replace(
                merged_variable, names=list(dict.fromkeys([*merged_variable.names, v.name])), starts=starts
            )
    return sorted(merged.values(), key=lambda s: list(_TITLES).index(s.variable.causality))


def blocks(tables: Mapping[str, Sequence[Variable]]) -> dict[str, str]:
    """Tables of the page by the names of their marks: one for each causality, a column of start values for each car."""
    results = {}
    for causality, title in _TITLES.items():
        members = [s for s in merge_variables(tables) if s.variable.causality == causality]
        starts = causality != "output"
        ranged = causality in ("input", "parameter")
        head = [
            "name",
            "unit",
            *(tables if starts else ["cars"]),
            *(["range", "variability"] if ranged else []),
            "what",
        ]
        rows = [head, ["---"] * len(head)]
        for s in members:
            v = s.variable
            values = [_starts_text(s, car) for car in tables] if starts else [_cars_text(s, tables)]
            low, high = (float("-inf") if v.min is None else v.min), (float("inf") if v.max is None else v.max)
            rows.append(
                [
                    _names_text(s.names),
                    "" if v.unit == "1" else v.unit,
                    *values,
                    *([range_text(low, high, "1"), v.variability] if ranged else []),
                    _description(s),
                ]
            )
        results[f"car {title}"] = "\n".join("| " + " | ".join(row) + " |" for row in rows)
    return results


def _table(name: str) -> tuple[Variable, ...]:
    car = load(name)
    makers = car.fidelities()
    names = [str(number.name).lower() for number in makers]
    meta = mbs.compile(car.model()).meta
    table = variable_table(meta, pose=True, step_size=float(meta["experiment"]["step_s"]), fidelities=names)
    texts = [Variable(t.name, "parameter", "fixed", "1", t.description, "text", 0) for t in text_table(meta, table)]
    return (*table, *texts)


def _common_name(v: Variable, present: set[str]) -> str:
    """Common name of a variable at all wheels or both axles."""
    plain = _WHEEL.sub("_FL", v.name)
    if plain != v.name and all(_WHEEL.sub(f"_{wheel}", v.name) in present for wheel in WHEELS):
        return plain
    front = re.sub(r"\brear\b", "front", v.name)
    return front if v.causality == "parameter" and front in present else v.name


def _similar_name(v: Variable) -> str:
    """Common name of parameters with the same description in the same table, such as the parameters of all payloads."""
    first, _, rest = v.name.partition(".")
    return f"{first}.*.{rest.rpartition('.')[2]}: {v.description.rpartition(': ')[2]}" if "." in rest else v.name


def _names_text(names: Sequence[str]) -> str:
    """Names in a row; of four wheels the first and the last."""
    if len(names) == len(WHEELS):
        return f"`{names[0]}` ... `{names[-1]}`"
    return ", ".join(f"`{name}`" for name in names)


def _description(s: MergedVariable) -> str:
    """The description without its prefix and with a small first letter."""
    text = s.variable.description
    for stem in (s.variable.name, s.variable.name.rpartition(".")[0]):
        text = text.removeprefix(f"{stem}: ")
    text = text.rstrip(".").replace("|", "\\|")
    return text if text[1:2].isupper() or not text else text[0].lower() + text[1:]


def _starts_text(s: MergedVariable, car: str) -> str:
    values = s.starts.get(car)
    if values is None:
        return "–"
    if not values:
        return "text"
    return ", ".join(f"{value:.6g}" for value in (values if len(set(values)) > 1 else values[:1]))


def _cars_text(s: MergedVariable, tables: Mapping[str, Sequence[Variable]]) -> str:
    return "all" if len(s.cars) == len(tables) else ", ".join(s.cars)
