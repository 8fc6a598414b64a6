"""Settings of an FMU before it starts: by a manoeuvre, parameter sets and the command line, in this order."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions
from hosts.fmu.parameter_file_settings import settings_of_file
from hosts.fmu.setting import Setting
from hosts.fmu.steering_ratios import steering_rows
from hosts.fmu.variables import Variables

START_OF = "start of "
"""How the source of a start value of a manoeuvre begins."""
_MOST_IN_TITLE = 2


class Settings:
    """Values by name; what is added later replaces what was there."""

    def __init__(self, variables: Variables) -> None:
        self._variables = variables
        self._settings: dict[str, Setting] = {}
        self._notes: list[tuple[str, str]] = []

    @property
    def start(self) -> dict[str, Value]:
        """Values by name."""
        return {name: s.value for name, s in self._settings.items()}

    @property
    def changes(self) -> list[Setting]:
        """Those that are not what the FMU starts with, in its order."""
        order = self._variables.names
        return sorted((s for s in self._settings.values() if s.changes), key=lambda s: order.index(s.variable.name))

    def add_numbers(self, values: Mapping[str, Value], source: str) -> None:
        """Values in the units of the FMU. `source`: how messages call where they come from.

        Raises `HostError`: a name, value or kind is wrong.
        """
        self._put([self._checked(name, value, source) for name, value in values.items()])

    def add_texts(self, values: Iterable[tuple[str, str]], source: str) -> None:
        """Values as a person writes them, in the units of the FMU; see `add_numbers`."""
        texts_by_name: dict[str, str] = {}
        for name, text in values:
            if texts_by_name.setdefault(name, text) != text:
                raise HostError(f"{source}: '{name}' is given as {texts_by_name[name]} and as {text}; give it once.")
        results = []
        for name, text in texts_by_name.items():
            variable = self._variables.settable(name, source)
            results.append(Setting(variable, variable.read(text, source, with_unit=True), source))
        self._put(results)
        for v, value in ((s.variable, s.value) for s in results if not s.changes):
            self._notes.append((v.name, f"{v.with_unit(value)} as in the FMU ({source})"))

    def add_set(self, file: Path) -> None:
        """Values of an SSV file in the units of the FMU; those that are its own replace nothing: a set may list all."""
        results, source = settings_of_file(file, self._variables), file.name
        self._put([setting for setting in results if setting.changes])
        unchanged = {setting.variable.name for setting in results if not setting.changes}
        for change in (setting for setting in self.changes if setting.variable.name in unchanged):
            self._notes.append(
                (change.variable.name, f"that of {change.source} stays: in {source} it is as in the FMU")
            )
        if not results:
            self._notes.append((source, "empty: it sets nothing"))
        elif len(unchanged) == len(results):
            self._notes.append((source, f"all {len(unchanged)} values are those of the FMU: it changes nothing"))
        else:
            self._notes.append(
                (source, f"{len(results)} values, {len(results) - len(unchanged)} of them other than in the FMU")
            )

    def add_wishes(self, fmu_options: FmuOptions, fidelity: float | None = None) -> None:
        """What the command line sets; see `add_numbers`. `fidelity`: of the option ``--fidelity``."""
        for file in fmu_options.sets:
            self.add_set(file)
        self.add_texts(fmu_options.values, "--set")
        if fidelity is not None:
            if "fidelity" in dict(fmu_options.values):
                raise HostError("The fidelity is given by --fidelity and by --set; give it once.")
            self.add_numbers({"fidelity": fidelity}, "--fidelity")

    def overwritten(self, names: Iterable[str], by: str) -> None:
        """Tell which settings have no effect, since something sets these inputs and parameters from the start on."""
        for name in names:
            if name in self._settings:
                setting = self._settings.pop(name)
                self._notes.append(
                    (name, f"{setting.variable.with_unit(setting.value)} of {setting.source} has no effect: {by}")
                )

    def rows(self) -> list[tuple[str, str]]:
        """Rows of a summary: what was set, and what does nothing."""
        changes = [(s.variable.name, s.words()) for s in self.changes]
        return self._notes + changes + steering_rows(self._variables, self.start)

    def title(self, name: str) -> str:
        """A name for a picture with the first of what the user has changed."""
        changes = [s for s in self.changes if not s.source.startswith(START_OF)]
        texts = [f"{s.variable.name} {s.variable.with_unit(s.value)}" for s in changes[:_MOST_IN_TITLE]]
        suffix = [f"{len(changes) - len(texts)} more"] if len(changes) > len(texts) else []
        return ", ".join([name, *texts, *suffix])

    def records(self) -> list[dict[str, Any]]:
        """The settings as JSON."""
        return [s.record() for s in self.changes]

    def _put(self, settings: Sequence[Setting]) -> None:
        """All or, where one was refused before, none."""
        for setting in settings:
            name, before = setting.variable.name, self._settings.get(setting.variable.name)
            if before is not None and before.changes and before.value != setting.value:
                old = before.variable.with_unit(before.value)
                self._notes.append((name, f"{setting.source} replaces {old} of {before.source}"))
            self._settings[name] = setting

    def _checked(self, name: str, value: Value, source: str) -> Setting:
        variable = self._variables.settable(name, source)
        return Setting(variable, variable.check(value, source), source)


def settings_of(variables: Variables, fmu_options: FmuOptions) -> Settings:
    """What the command line sets in an FMU. Raises `HostError`: a name, value, kind or unit is wrong."""
    settings = Settings(variables)
    settings.add_wishes(fmu_options)
    return settings
