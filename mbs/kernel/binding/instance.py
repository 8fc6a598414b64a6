"""Binding of one kernel instance: state of a System, inputs, parameters, and the calls that make steps."""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from ctypes import byref, c_char_p, c_double, c_int32, c_int64, c_void_p
from typing import Any

from ..header.limits import POSE
from ..header.steps import Balance
from ..header.structures import ControlFields, InputTable, InputTables, RecordFields, SettingsFields
from .buffers import DOUBLES, buffer, numbers, pointer
from .errors import KernelError
from .loaded_system import LoadedSystem
from .standing_instance import StandingInstance

_INPUT_FUNCTION = ctypes.CFUNCTYPE(c_int32, c_void_p, c_double, c_int32, DOUBLES)


class Instance(StandingInstance):
    """State of a System with the work space for its steps."""

    def __init__(self, system: LoadedSystem) -> None:
        self._input_error: BaseException | None = None
        super().__init__(system)
        self._step = self._library.ali3_step
        self._turn = threading.RLock()  # calls release Python's lock, and the work space is for one step at a time
        self._inputs: Any = None  # keeps alive the function or the tables that the kernel uses

    def _check(self, status: int) -> None:
        if status:
            error, self._input_error = self._input_error, None
            if error is not None:
                raise error
        super()._check(status)

    def reset(self) -> None:
        """Reset state, settings, inputs and parameters to the values of the System file."""
        self._check(self._library.ali3_reset(self._handle))

    def settings(self) -> dict[str, float | int]:
        """Present settings by field name."""
        fields = SettingsFields()
        self._check(self._library.ali3_get_settings(self._handle, byref(fields)))
        return {name: getattr(fields, name) for name, _ in SettingsFields._fields_}

    def set_settings(self, **values: float) -> None:
        """Change settings, by field name."""
        fields = SettingsFields()
        self._check(self._library.ali3_get_settings(self._handle, byref(fields)))
        field_types = dict(SettingsFields._fields_)
        for name, value in values.items():
            if name not in field_types:
                raise TypeError(f"{name!r} is not a setting of the kernel.")
            setattr(fields, name, int(value) if field_types[name] is c_int32 else float(value))
        self._check(self._library.ali3_set_settings(self._handle, byref(fields)))

    def set_input(self, index: int, value: float) -> None:
        """Set an input; its value is clamped to its range."""
        self._check(self._library.ali3_set_input(self._handle, index, value))

    def get_input(self, index: int) -> float:
        """Present value of an input."""
        value = c_double()
        self._check(self._library.ali3_get_input(self._handle, index, byref(value)))
        return value.value

    def set_input_function(self, function: Callable[[float, bool, Any], None] | None) -> None:
        """Compute inputs by a function of time, called at each time at which a method evaluates them; None removes it.

        `function`: called with the time, s, whether values after a jump at this time are requested, and a writable
        array of all inputs with their present values. An exception ends the step and is raised by `step` or `run`.
        """

        def evaluate_inputs(_: Any, t: float, after: int, values: Any) -> int:
            try:
                function(t, bool(after), values)  # type: ignore[misc]
            except BaseException as error:
                self._input_error = error
                return 1
            return 0

        self._inputs = _INPUT_FUNCTION(evaluate_inputs) if function is not None else None
        address = ctypes.cast(self._inputs, c_void_p) if function is not None else None
        self._check(self._library.ali3_set_input_function(self._handle, address, None))

    def set_input_tables(self, tables: Mapping[int, tuple[Any, Any]], tolerance: float) -> None:
        """Set inputs as functions of time by tables, which the kernel reads without calling Python.

        `tables`: times, s, not decreasing, and values of an input, contiguous float64 buffers, by number of the input;
        `tolerance`: largest distance from a jump at which a time counts as the jump, s.
        """
        buffers = {
            i: [buffer(x, len(table[0]), "a table", writable=False) for x in table] for i, table in tables.items()
        }
        rows = [InputTable(i, len(a[0]), *map(pointer, a)) for i, a in buffers.items()]
        context = InputTables(tolerance, len(rows), (InputTable * len(rows))(*rows))
        address = ctypes.cast(self._library.ali3_input_of_tables, c_void_p)
        self._check(self._library.ali3_set_input_function(self._handle, address, ctypes.cast(byref(context), c_void_p)))
        self._inputs = (context, buffers)

    def set_input_breaks(self, times: Any) -> None:
        """Set the times, s, ascending, of jumps of the present function or tables, at which steps are divided."""
        self._breaks = buffer(times, len(times), "the breaks", writable=False)
        self._check(self._library.ali3_set_input_breaks(self._handle, self._breaks, len(times)))

    def get_parameter(self, index: int) -> float:
        """Present value of a parameter."""
        value = c_double()
        self._check(self._library.ali3_get_parameter(self._handle, index, byref(value)))
        return value.value

    def set_road(self, index: int, path: str | os.PathLike[str] | None) -> None:
        """Replace a road of the System by a road file at the next `initialise`; None: the road of the System.

        Raises `KernelError` if the file is refused; then the road does not change.
        """
        message = ctypes.create_string_buffer(512)
        text = "" if path is None else os.fspath(path)
        name = text.encode() if sys.platform == "win32" else os.fsencode(text)
        status = self._library.ali3_set_road(self._handle, index, name, message, len(message))
        if status and message.value:
            raise KernelError(status, f"the road '{path}' was refused: {message.value.decode(errors='replace')}.")
        self._check(status)

    def road_lost(self) -> str:
        """Fault of a road file after the status `ROAD_LOST`, with the part of the file; otherwise empty."""
        return bytes(self._library.ali3_road_lost(self._handle)).decode(errors="replace")

    def beyond_table(self) -> tuple[int, float, float, float]:
        """Coordinate farthest outside its table (-1: none), its value and both ends of the table."""
        column, numbers = c_int32(-1), (c_double * 3)()
        self._library.ali3_beyond_table(self._handle, byref(column), numbers)
        return column.value, *numbers

    def wheel_in_road(self) -> tuple[int, str]:
        """Element whose wheel centre is below a grid road (-1: none), and a description."""
        element, text = c_int32(-1), ctypes.create_string_buffer(512)
        self._library.ali3_wheel_in_road(self._handle, byref(element), text, len(text))
        return element.value, text.value.decode(errors="replace")

    def set_pose(
        self,
        x: float = 0.0,
        y: float = 0.0,
        z: float = 0.0,
        yaw: float = 0.0,
        speed: float = 0.0,
        lateral_speed: float = 0.0,
        yaw_rate: float = 0.0,
    ) -> None:
        """Set the start of a floating scene (m, rad, m/s, rad/s); before `initialise`."""
        pose = (x, y, z, yaw, speed, lateral_speed, yaw_rate)
        self._check(self._library.ali3_set_pose(self._handle, numbers(pose, POSE, "pose")))

    def set_q(self, q: Sequence[float] | None, qd: Sequence[float] | None = None) -> None:
        """Set start values of coordinates, shape (nq,), and rates, shape (nq,); before `initialise`."""
        nq = self.system.sizes.nq
        self._check(self._library.ali3_set_q(self._handle, numbers(q, nq, "q"), numbers(qd, nq, "qd")))

    def set_switch(self, index: int, on: bool) -> None:
        """Switch constraint rows on or off; rows that are switched on hold their present values."""
        self._check(self._library.ali3_set_switch(self._handle, index, int(on)))

    def get_switch(self, index: int) -> bool:
        """Whether the rows of a switch are on."""
        on = c_int32()
        self._check(self._library.ali3_get_switch(self._handle, index, byref(on)))
        return bool(on.value)

    def settle(self, duration: float, h: float) -> float:
        """Settle all motion of a start but the horizontal one, which is held; after `initialise`.

        `duration`: time to settle, s, at most `LONGEST_SETTLING`; `h`: step, s. Returns the largest remaining speed
        relative to the held motion, m/s.
        """
        self._start(self._library.ali3_settle(self._handle, duration, h))
        return float(self._library.ali3_unsettled(self._handle))

    def start_text(self) -> str:
        """Sentence about a start on a road file that is not level there; otherwise empty."""
        return self._text(self._library.ali3_start_text)

    def start_excess(self) -> tuple[float, int, str]:
        """Reason of a start that was refused with `START_REFUSED`.

        Returns
        -------
        float
            Height by which the scene must be raised so that no element refuses it, m.
        int
            Element with the largest excess; -1: none.
        str
            Reason of that element, the continuation of a sentence that begins with its name.
        """
        element, reason = c_int32(), c_char_p()
        height = self._library.ali3_start_excess(self._handle, byref(element), byref(reason))
        return float(height), element.value, (reason.value or b"").decode()

    def method_excludes(self) -> str:
        """Property of Systems that the method of the settings does not accept; empty if it accepts all."""
        return bytes(self._library.ali3_method_excludes(self._handle)).decode()

    def step(self, h: float) -> None:
        """Make one step of `h` seconds with the present inputs."""
        with self._turn:
            status = self._step(self._handle, h)
        if status:
            self._check(status)

    def run(self, h: float, n: int, inputs: Any = None, every: int = 1, out: Any = None, positions: Any = None) -> int:
        """Make steps of equal length.

        Parameters
        ----------
        h : float
            Step, s.
        n : int
            Number of steps.
        inputs : buffer of float64, shape (n, nu), optional
            Input values, a row per step; None keeps the present ones.
        every : int
            Number of steps between two records of the sensors.
        out : writable buffer of float64, shape (n // every, ns), optional
            Receives the sensor values.
        positions : writable buffer of float64, shape (n // every, nq), optional
            Receives the coordinates of the same states.

        Returns
        -------
        int
            Number of steps made.
        """
        sizes = self.system.sizes
        records = n // every if every > 0 else 0
        buffers = (
            buffer(inputs, n * sizes.nu, "inputs", writable=False),
            every,
            buffer(out, records * sizes.ns, "out", writable=True),
            buffer(positions, records * sizes.nq, "positions", writable=True),
        )
        steps_done = c_int64()
        with self._turn:
            status = self._library.ali3_run(self._handle, h, n, *buffers, byref(steps_done))
        self._check(status)
        return steps_done.value

    def control_run(
        self,
        control: ControlFields,
        scale: Any,
        t_end: float,
        max_steps: int,
        times: Any,
        sensors: Any,
        positions: Any,
        done: int,
    ) -> int:
        """Make steps under error control, whose errors add up to a tolerance; see `ali3_control_run`.

        Parameters
        ----------
        control : ControlFields
            Settings and counters, changed in place.
        scale : buffer of float64, shape (nq,)
            Length, m, that corresponds to one unit of each coordinate.
        t_end : float
            Time at which the last step must end, s.
        most_steps : int
            Number of accepted steps after which the call returns.
        times : buffer of float64, shape (n,)
            Times to record at, ascending.
        sensors, positions : writable buffers of float64, shape (n, ns) and (n, nq)
            Receive the records; either may be None.
        done : int
            Number of rows that earlier calls have written.

        Returns
        -------
        int
            Number of rows written, including earlier calls.
        """
        sizes, n = self.system.sizes, memoryview(times).nbytes // 8
        rows = (
            buffer(times, n, "times", writable=False),
            buffer(sensors, n * sizes.ns, "sensors", writable=True),
            buffer(positions, n * sizes.nq, "positions", writable=True),
        )
        record = RecordFields(n, *map(pointer, rows))
        written = c_int64(done)
        lengths = buffer(scale, sizes.nq, "scale", writable=False)
        with self._turn:
            status = self._library.ali3_control_run(
                self._handle, byref(control), lengths, t_end, max_steps, byref(record), byref(written)
            )
        self._check(status)
        return written.value

    def refresh(self) -> None:
        """Compute accelerations and multipliers again after a jump of inputs or driving functions; drop past steps."""
        self._check(self._library.ali3_refresh(self._handle))

    def follow(self, other: Instance) -> None:
        """Set the state from the same model without ports, and compute the forces at the ports, for `sensors`.

        `other`: initialised, not changed. This System has the maps of `mbs.compiler.ports.with_ports_of`.
        """
        self._check(self._library.ali3_ports_follow(self._handle, other._handle))

    def balance_wrong(self) -> bool:
        """Whether the run is wrong by its energy balance; see `ali3_report.balance`."""
        return bool(self._report().balance == Balance.WRONG)

    def branch_text(self) -> str:
        """Sentence about the first change of the assembly mode of a closed loop; empty if there was none."""
        return self._text(self._library.ali3_branch_text)

    def rim_text(self) -> tuple[int, str]:
        """Element whose rim was deepest in a road (-1: none), and a sentence about it."""
        element, text = c_int32(-1), ctypes.create_string_buffer(1024)
        self._library.ali3_rim_text(self._handle, byref(element), text, len(text))
        return element.value, text.value.decode(errors="replace")

    def _text(self, function: Callable[..., int]) -> str:
        text = ctypes.create_string_buffer(1024)
        self._check(function(self._handle, text, len(text)))
        return text.value.decode(errors="ignore")

    @property
    def time(self) -> float:
        """Time of the state, s."""
        return float(self._library.ali3_time(self._handle))

    def save(self) -> bytes:
        """Complete state as bytes, from which a run continues bit for bit."""
        data = ctypes.create_string_buffer(self.system.state_size)
        self._check(self._library.ali3_state_save(self._handle, data, len(data)))
        return data.raw

    def restore(self, data: bytes) -> None:
        """Restore a state that `save` of the same System returned; altered bytes raise `KernelError`."""
        self._check(self._library.ali3_state_restore(self._handle, bytes(data), len(data)))

    def snapshot(self) -> Any:
        """Copy of the state in memory, for `at` of this instance; faster than `save`."""
        data = ctypes.create_string_buffer(self.system.snapshot_size)
        self._library.ali3_snapshot_take(self._handle, data)
        return data

    @contextmanager
    def at(self, snapshot: Any) -> Iterator[None]:
        """Context in which the instance is in the state of a snapshot; its present state is restored at the end."""
        present = self.snapshot()
        self._library.ali3_snapshot_restore(self._handle, snapshot)
        try:
            yield
        finally:
            self._library.ali3_snapshot_restore(self._handle, present)

    def evaluate(
        self, q: Sequence[float], qd: Sequence[float], y: Sequence[float] | None = None, t: float | None = None
    ) -> dict[str, Any]:
        """Constraint rows, forces and element outputs at given coordinates; the state of the instance is not changed.

        Returns `phi`, `phi_t`, `gamma` (nc,), `jacobian` (nnz_rows,) of the stored rows, `force` (nq,), `outputs`
        (nout,).
        """
        s = self.system.sizes
        counts = {"phi": s.nc, "jacobian": s.nnz_rows, "phi_t": s.nc, "gamma": s.nc, "force": s.nq, "outputs": s.nout}
        values = {name: (c_double * n)() for name, n in counts.items()}
        arguments = (numbers(q, s.nq, "q"), numbers(qd, s.nq, "qd"), numbers(y, s.ny, "y"))
        time = self.time if t is None else t
        self._check(self._library.ali3_evaluate(self._handle, *arguments, time, *values.values()))
        return values

    def tangent(self, h: float, lam: Sequence[float] | None = None) -> Any:
        """The tangent (23) at the present state for step `h`: C array of nq * nq, symmetric."""
        sizes = self.system.sizes
        dense = (c_double * (sizes.nq * sizes.nq))()
        self._check(self._library.ali3_tangent(self._handle, h, numbers(lam, sizes.nc, "lam"), dense))
        return dense

    def mass_matrix(self, q: Sequence[float]) -> Any:
        """M(q): C array of nq * nq, symmetric; it depends on q only where bodies are flexible."""
        nq = self.system.sizes.nq
        dense = (c_double * (nq * nq))()
        self._check(self._library.ali3_mass_matrix(self._handle, numbers(q, nq, "q"), dense))
        return dense

    def element_step(
        self, q: Sequence[float], qd: Sequence[float], y_old: Sequence[float] | None, h: float
    ) -> tuple[Any, Any]:
        """Element states (ny,) after `h` seconds at constant q, qd, and the generalised force (nq,) in these states."""
        s = self.system.sizes
        y_new, force = (c_double * s.ny)(), (c_double * s.nq)()
        arguments = (numbers(q, s.nq, "q"), numbers(qd, s.nq, "qd"), numbers(y_old, s.ny, "y_old"))
        self._check(self._library.ali3_element_step(self._handle, *arguments, h, y_new, force))
        return y_new, force
