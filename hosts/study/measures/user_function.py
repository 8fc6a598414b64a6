"""A function of the user that computes measures of a run."""

import hashlib
import inspect
import math
import numbers
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from ali3.message_text import sentence_of
from ali3.processes import path_of_caller
from ali3.reading import LARGEST_TEXT, read_text
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from hosts.study.measures.expression import similar_names


@dataclass(frozen=True)
class UserFunction:
    """A function in a file; made by `read_user_function`.

    It holds the source of the file, so that a worker on another machine does not need the file.
    """

    name: str
    """Name of its column, or prefix of its columns."""
    file: str
    """Path of the file, as the user gave it."""
    function: str
    """Name of the function."""
    source: str
    """Text of the file."""

    @property
    def text(self) -> str:
        """File and function."""
        return f"{self.file}:{self.function}"

    @property
    def digest(self) -> str:
        """Hash of the source."""
        return hashlib.sha256(f"{self.function}\n{self.source}".encode()).hexdigest()

    def columns(self, units: Mapping[str, str], stop_time: float | None = None) -> dict[str, str]:
        """The declared columns with their units; see `hosts.study.measures.study_measure.StudyMeasure`."""
        declared = getattr(_load(self), "units", "1")
        if isinstance(declared, str):
            return {self.name: declared or "1"}
        if (
            not isinstance(declared, Mapping)
            or not declared
            or not all(isinstance(k, str) and k and isinstance(v, str) for k, v in declared.items())
        ):
            raise HostError(
                f'{self.text}: {self.function}.units is {declared!r:.80}; it must be a unit such as "m/s2", or a '
                f'mapping of the names of its numbers to their units: {self.function}.units = {{"peak": "m/s2"}}.'
            )
        return {f"{self.name}.{k}": v or "1" for k, v in declared.items()}

    def evaluate(self, result: Result, parameters: Mapping[str, Value] | None = None) -> list[Measure]:
        """Call the function and return a measure for each column; see `StudyMeasure`."""
        columns = self.columns(result.units)
        values, note = dict.fromkeys(columns, math.nan), ""
        notes: dict[str, str] = {}
        if result.refusal:
            note = sentence_of(result.refusal)
        else:
            try:
                values_by_name = self._by_column(self._call(result, dict(parameters or {})), columns)
                values = {name: _number(value) for name, value in values_by_name.items()}
                notes = {
                    name: f"{self.text} gave {value!r:.60}, not a finite number."
                    for name, value in values_by_name.items()
                    if not math.isfinite(values[name])
                }
            except Exception as error:
                note = str(error) if isinstance(error, HostError) else _error_text(self, error)
        return [Measure(n, values[n], columns[n], self.text, note=notes.get(n, note)) for n in columns]

    def _call(self, result: Result, parameters: dict[str, Value]) -> Any:
        function = _load(self)
        with _import_folder(self):
            return function(result, parameters) if _takes_parameters(function) else function(result)

    def _by_column(self, value: Any, columns: Mapping[str, str]) -> dict[str, Any]:
        """The value of the function by the names of the columns. Raises `HostError` if it is not as declared."""
        is_single = list(columns) == [self.name]
        if not isinstance(value, Mapping):
            if is_single:
                return {self.name: value}
            raise HostError(f"{self.text} gave {value!r:.60}; {self.function}.units declares a mapping.")
        if is_single:
            example = ", ".join(f'{str(k)!r}: "1"' for k in list(value)[:3])
            raise HostError(
                f"{self.text} gave a mapping; declare its names and units behind the function, such as "
                f"{self.function}.units = {{{example}}}."
            )
        columns_by_key = {name.removeprefix(f"{self.name}."): name for name in columns}
        if set(value) != set(columns_by_key):
            raise HostError(
                f"{self.text} gave {', '.join(map(str, value)) or 'nothing'}; {self.function}.units declares "
                f"{', '.join(columns_by_key)}."
            )
        return {columns_by_key[k]: value[k] for k in columns_by_key}


def read_user_function(file: Path, function: str, name: str = "") -> UserFunction:
    """Read the file and load it once, so that its mistakes are reported before the first run.

    `name`: name of the measure; by default the name of the function. Raises `HostError` if the file or the
    function is missing, or the file cannot be run.
    """
    if not function.isidentifier():
        raise HostError(f"'{file}:{function}' names no function; the form is file.py:function.")
    source = read_text(file, LARGEST_TEXT, HostError, f"{file}, in which the function {function} is to be,")
    user_function = UserFunction(name or function, str(file), function, source)
    _load(user_function)
    user_function.columns({})
    return user_function


@contextmanager
def _import_folder(function: UserFunction) -> Iterator[None]:
    """Add the folder of the file to the search path of modules, so that it can import other files there."""
    folder = str(Path(path_of_caller(function.file)).resolve().parent)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)


@lru_cache(maxsize=100)
def _load(function: UserFunction) -> Callable[..., Any]:
    """The function, after running its file as a module, once in a process."""
    module = ModuleType(f"study_function_{hashlib.sha256(function.source.encode()).hexdigest()[:16]}")
    module.__file__ = function.file
    # Data classes and pickling find the module of a class by its name.
    sys.modules[module.__name__] = module
    try:
        with _import_folder(function):
            exec(compile(function.source, function.file, "exec"), module.__dict__)
    except (Exception, SystemExit) as error:
        raise HostError(_error_text(function, error)) from None
    result = getattr(module, function.function, None)
    if result is None:
        functions = {n: "" for n, value in vars(module).items() if inspect.isfunction(value)}
        raise HostError(
            f"{function.file} has no function '{function.function}'{similar_names(function.function, functions)}"
        )
    if not callable(result):
        raise HostError(f"{function.text} is {type(result).__name__}, not a function.")
    _takes_parameters(result, function.text)
    return result  # type: ignore[no-any-return]


def _takes_parameters(function: Callable[..., Any], text: str = "") -> bool:
    """Whether a function takes the parameters of the run in addition to the result. `text`: its name in messages."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # of a function in C
        return False
    for count in (2, 1):
        try:
            signature.bind(*range(count))
        except TypeError:
            continue
        return count == 2
    raise HostError(f"{text} takes {signature}; it must take (result), or (result, parameters).")


def _number(value: Any) -> float:
    """The value as a number; NaN for other values."""
    try:
        number = float(value) if isinstance(value, numbers.Real) or hasattr(value, "__float__") else math.nan
    except (TypeError, ValueError):
        return math.nan
    return number if math.isfinite(number) else math.nan


def _error_text(function: UserFunction, error: BaseException) -> str:
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == function.file]
    line = error.lineno if isinstance(error, SyntaxError) else lines[-1] if lines else None
    message = error.msg if isinstance(error, SyntaxError) else str(error)
    where = f"{function.text}, line {line}" if line is not None else function.text
    return f"{where}: {type(error).__name__}: {message}".rstrip(": ") + "."
