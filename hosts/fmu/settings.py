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
"""Prefix of the source of start values of a manoeuvre."""
_MAX_SETTINGS_IN_TITLE = 2


class Settings:
    """Settings by name; later ones replace earlier ones."""

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
        """Settings that differ from the start values of the FMU, in its order."""
        order = self._variables.names
        return sorted((s for s in self._settings.values() if s.changes), key=lambda s: order.index(s.variable.name))

    def add_numbers(self, values: Mapping[str, Value], source: str) -> None:
        """Add values in the units of the FMU. `source`: source of the values, for messages.

        Raises `HostError` if a name, value or type is wrong.
        """
        self._put([self._check_setting(name, value, source) for name, value in values.items()])

    def add_texts(self, values: Iterable[tuple[str, str]], source: str) -> None:
        """Add values as text, in the units of the FMU or with a unit; see `add_numbers`."""
        texts_by_name: dict[str, str] = {}
        for name, text in values:
            if texts_by_name.setdefault(name, text) != text:
                raise HostError(f"{source}: '{name}' is given as {texts_by_name[name]} and as {text}; give it once.")
        settings = []
        for name, text in texts_by_name.items():
            variable = self._variables.settable(name, source)
            settings.append(Setting(variable, variable.read(text, source, with_unit=True), source))
        self._put(settings)
        for v, value in ((s.variable, s.value) for s in settings if not s.changes):
            self._notes.append((v.name, f"{v.with_unit(value)} as in the FMU ({source})"))

    def add_set(self, file: Path, source: str = "") -> None:
        """Add values of an SSV file; default values of the FMU replace nothing, for a set may list all parameters.

        `source`: how messages call the file; by default by its name.
        """
        source = source or file.name
        settings = settings_of_file(file, self._variables, source)
        self._put([setting for setting in settings if setting.changes])
        unchanged = {setting.variable.name for setting in settings if not setting.changes}
        for change in (setting for setting in self.changes if setting.variable.name in unchanged):
            self._notes.append(
                (change.variable.name, f"that of {change.source} stays: in {source} it is as in the FMU")
            )
        if not settings:
            self._notes.append((source, "empty: it sets nothing"))
        elif len(unchanged) == len(settings):
            self._notes.append((source, f"all {len(unchanged)} values are those of the FMU: it changes nothing"))
        else:
            self._notes.append(
                (source, f"{len(settings)} values, {len(settings) - len(unchanged)} of them other than in the FMU")
            )

    def add_options(self, fmu_options: FmuOptions, fidelity: float | None = None) -> None:
        """Add the settings of the command line; see `add_numbers`. `fidelity`: value of ``--fidelity``."""
        names = [file.name for file in fmu_options.sets]
        for file in fmu_options.sets:
            self.add_set(file, str(file) if names.count(file.name) > 1 else file.name)
        self.add_texts(fmu_options.values, "--set")
        if fidelity is not None:
            if "fidelity" in dict(fmu_options.values):
                raise HostError("The fidelity is given by --fidelity and by --set; give it once.")
            self.add_numbers({"fidelity": fidelity}, "--fidelity")

    def discard_overwritten(self, names: Iterable[str], reason: str) -> None:
        """Drop settings of variables that are overwritten at the start, with a note. `reason`: text of the note."""
        for name in names:
            if name in self._settings:
                setting = self._settings.pop(name)
                self._notes.append(
                    (name, f"{setting.variable.with_unit(setting.value)} of {setting.source} has no effect: {reason}")
                )

    def rows(self) -> list[tuple[str, str]]:
        """Rows of a summary, name and text: notes, changes, and constants that they affect."""
        changes = [(s.variable.name, s.words()) for s in self.changes]
        return self._notes + changes + steering_rows(self._variables, self.start)

    def title(self, name: str) -> str:
        """A title: the name and the first changes of the user."""
        changes = [s for s in self.changes if not s.source.startswith(START_OF)]
        texts = [f"{s.variable.name} {s.variable.with_unit(s.value)}" for s in changes[:_MAX_SETTINGS_IN_TITLE]]
        suffix = [f"{len(changes) - len(texts)} more"] if len(changes) > len(texts) else []
        return ", ".join([name, *texts, *suffix])

    def records(self) -> list[dict[str, Any]]:
        """The settings as JSON."""
        return [s.record() for s in self.changes]

    def _put(self, settings: Sequence[Setting]) -> None:
        """Store settings, with notes on those that they replace."""
        for setting in settings:
            name, before = setting.variable.name, self._settings.get(setting.variable.name)
            if before is not None and before.changes and before.value != setting.value:
                old = before.variable.with_unit(before.value)
                self._notes.append((name, f"{setting.source} replaces {old} of {before.source}"))
            self._settings[name] = setting

    def _check_setting(self, name: str, value: Value, source: str) -> Setting:
        variable = self._variables.settable(name, source)
        return Setting(variable, variable.check(value, source), source)


def settings_of(variables: Variables, fmu_options: FmuOptions) -> Settings:
    """The settings of the command line for an FMU. Raises `HostError` if a name, value, type or unit is wrong."""
    settings = Settings(variables)
    settings.add_options(fmu_options)
    return settings
