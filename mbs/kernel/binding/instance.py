"""A State of a System and the work space to step it."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, c_int64, c_void_p
from typing import Any

from ..header.limits import POSE
from ..header.steps import Balance
from ..header.structures import ControlFields, InputTable, InputTables, RecordFields, SettingsFields
from .buffers import buffer, numbers
from .errors import KernelError
from .loaded_system import LoadedSystem
from .standing_instance import StandingInstance

_DOUBLES = POINTER(c_double)
_INPUT_FUNCTION = ctypes.CFUNCTYPE(c_int32, c_void_p, c_double, c_int32, _DOUBLES)


class Instance(StandingInstance):
    """A State of a System and the work space to step it."""

    def __init__(self, system: LoadedSystem) -> None:
        self._input_error: BaseException | None = None
        super().__init__(system)
        self._step = self._library.ali3_step
        self._inputs: Any = None  # keeps what the kernel calls and reads

    def _check(self, status: int) -> None:
        if status:
            error, self._input_error = self._input_error, None
            if error is not None:
                raise error
        super()._check(status)

    def reset(self) -> None:
        """Back to the values of the System file; settings, inputs and parameters too."""
        self._check(self._library.ali3_reset(self._handle))

    def settings(self) -> dict[str, float | int]:
        """Present settings by field name."""
        fields = SettingsFields()
        self._check(self._library.ali3_get_settings(self._handle, byref(fields)))
        return {name: getattr(fields, name) for name, _ in SettingsFields._fields_}

    def set_settings(self, **values: float) -> None:
        """Change the settings named; the others stay."""
        fields = SettingsFields()
        self._check(self._library.ali3_get_settings(self._handle, byref(fields)))
        known = dict(SettingsFields._fields_)
        for name, value in values.items():
            if name not in known:
                raise TypeError(f"{name!r} is not a setting of the kernel.")
            setattr(fields, name, int(value) if known[name] is c_int32 else float(value))
        self._check(self._library.ali3_set_settings(self._handle, byref(fields)))

    def set_input(self, index: int, value: float) -> None:
        """Value of an input from now on, clamped to its range."""
        self._check(self._library.ali3_set_input(self._handle, index, value))

    def get_input(self, index: int) -> float:
        """Present value of an input."""
        value = c_double()
        self._check(self._library.ali3_get_input(self._handle, index, byref(value)))
        return value.value

    def set_input_function(self, function: Callable[[float, bool, Any], None] | None) -> None:
        """Inputs as a function of time, asked for at every time at which a method looks at them; None ends that.

        `function`: called with the time in s, whether the value behind a jump is meant, and a writable array of all
        inputs that holds the present ones. What it raises ends the step and is raised by `step` or `run`.
        """

        def ask(_: Any, t: float, after: int, values: Any) -> int:
            try:
                function(t, bool(after), values)  # type: ignore[misc]
            except BaseException as error:
                self._input_error = error
                return 1
            return 0

        self._inputs = _INPUT_FUNCTION(ask) if function is not None else None
        address = ctypes.cast(self._inputs, c_void_p) if function is not None else None
        self._check(self._library.ali3_set_input_function(self._handle, address, None))

    def set_input_tables(self, tables: Mapping[int, tuple[Any, Any]], tolerance: float) -> None:
        """The same from tables, without a call of Python.

        `tables`: per number of an input two contiguous float64 buffers of equal length; times do not decrease;
        `tolerance`: times this near to a jump are at it, s.
        """
        alive = {i: [buffer(x, len(table[0]), "a table", writable=False) for x in table] for i, table in tables.items()}
        rows = [InputTable(i, len(a[0]), *(ctypes.cast(x, _DOUBLES) for x in a)) for i, a in alive.items()]
        context = InputTables(tolerance, len(rows), (InputTable * len(rows))(*rows))
        address = ctypes.cast(self._library.ali3_input_of_tables, c_void_p)
        self._check(self._library.ali3_set_input_function(self._handle, address, ctypes.cast(byref(context), c_void_p)))
        self._inputs = (context, alive)

    def set_input_breaks(self, times: Any) -> None:
        """Times at which the present function or tables jump, s, ascending: steps are made in parts that end there."""
        self._breaks = buffer(times, len(times), "the breaks", writable=False)
        self._check(self._library.ali3_set_input_breaks(self._handle, self._breaks, len(times)))

    def get_parameter(self, index: int) -> float:
        """Present value of a parameter."""
        value = c_double()
        self._check(self._library.ali3_get_parameter(self._handle, index, byref(value)))
        return value.value

    def set_road(self, index: int, path: str | os.PathLike[str] | None) -> None:
        """A road file in place of a road of the System, for the next `initialise`; None: the System's own again.

        Raises `KernelError`: the file is refused; the road stays as it was.
        """
        message = ctypes.create_string_buffer(512)
        text = "" if path is None else os.fspath(path)
        name = text.encode() if sys.platform == "win32" else os.fsencode(text)
        status = self._library.ali3_set_road(self._handle, index, name, message, len(message))
        if status and message.value:
            raise KernelError(status, f"the road '{path}' was refused: {message.value.decode(errors='replace')}.")
        self._check(status)

    def road_lost(self) -> str:
        """What is wrong with which part of a road's file, after `ROAD_LOST`; else empty."""
        return bytes(self._library.ali3_road_lost(self._handle)).decode(errors="replace")

    def beyond_table(self) -> tuple[int, float, float, float]:
        """The coordinate that is farthest beyond its table, its value and both ends of the table; -1 if none is."""
        column, numbers = c_int32(-1), (c_double * 3)()
        self._library.ali3_beyond_table(self._handle, byref(column), numbers)
        return column.value, *numbers

    def wheel_in_road(self) -> tuple[int, str]:
        """The element whose wheel has its centre below a grid road, and words on it; -1 and none if there is none."""
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
        """Start of a scene that is not tied to the ground (m, rad, m/s, rad/s); before `initialise`."""
        pose = (x, y, z, yaw, speed, lateral_speed, yaw_rate)
        self._check(self._library.ali3_set_pose(self._handle, numbers(pose, POSE, "pose")))

    def set_q(self, q: Sequence[float] | None, qd: Sequence[float] | None = None) -> None:
        """Coordinates (nq,) and rates (nq,) to start from; before `initialise`."""
        nq = self.system.sizes.nq
        self._check(self._library.ali3_set_q(self._handle, numbers(q, nq, "q"), numbers(qd, nq, "qd")))

    def set_switch(self, index: int, on: bool) -> None:
        """Rows of a switch on or off; those that go on hold the values they have now."""
        self._check(self._library.ali3_set_switch(self._handle, index, int(on)))

    def get_switch(self, index: int) -> bool:
        """Whether the rows of a switch are on."""
        on = c_int32()
        self._check(self._library.ali3_get_switch(self._handle, index, byref(on)))
        return bool(on.value)

    def settle(self, duration: float, h: float) -> float:
        """Hold the horizontal motion of a start while all else settles; after `initialise`.

        `duration`: in s, at most `LONGEST_SETTLING`; `h`: of the steps, s. Returns the largest speed that is left
        beside the held motion, m/s.
        """
        self._start(self._library.ali3_settle(self._handle, duration, h))
        return float(self._library.ali3_unsettled(self._handle))

    def start_text(self) -> str:
        """A sentence on a start on a road of a file that is not level; empty where there is nothing to say."""
        return self._text(self._library.ali3_start_text)

    def start_excess(self) -> tuple[float, int, str]:
        """Why a start was refused with `START_REFUSED`.

        Returns
        -------
        float
            How much higher the scene must start, m, so that it is out of the way of all elements.
        int
            The element that refuses the start most; -1: none does.
        str
            Its words, after its name.
        """
        element, words = c_int32(), c_char_p()
        height = self._library.ali3_start_excess(self._handle, byref(element), byref(words))
        return float(height), element.value, (words.value or b"").decode()

    def method_excludes(self) -> str:
        """What the method of the settings takes no System with, in words; empty if it takes all."""
        return bytes(self._library.ali3_method_excludes(self._handle)).decode()

    def step(self, h: float) -> None:
        """One step of `h` seconds with the inputs as they are."""
        status = self._step(self._handle, h)
        if status:
            self._check(status)

    def run(self, h: float, n: int, inputs: Any = None, every: int = 1, out: Any = None, positions: Any = None) -> int:
        """`n` steps of `h` seconds.

        Parameters
        ----------
        h : float
            Step, s.
        inputs : buffer of float64, shape (n, nu), optional
            Input values, a row per step; None keeps them as they are.
        every : int
            Sensors are recorded after every so many steps.
        out : writable buffer of float64, shape (n // every, ns), optional
            Takes the sensor values.
        positions : writable buffer of float64, shape (n // every, nq), optional
            Takes the coordinates at the same states.

        Returns
        -------
        int
            Steps done; less than `n` never without a `KernelError`.
        """
        sizes = self.system.sizes
        given = buffer(inputs, n * sizes.nu, "inputs", writable=False)
        taken = buffer(out, n // every * sizes.ns if every > 0 else 0, "out", writable=True)
        places = buffer(positions, n // every * sizes.nq if every > 0 else 0, "positions", writable=True)
        done = c_int64()
        self._check(self._library.ali3_run(self._handle, h, n, given, every, taken, places, byref(done)))
        return done.value

    def control_run(
        self,
        control: ControlFields,
        scale: Any,
        t_end: float,
        most_steps: int,
        times: Any,
        sensors: Any,
        positions: Any,
        done: int,
    ) -> int:
        """Steps whose errors add up to a tolerance, see `ali3_control_run`.

        Parameters
        ----------
        control : ControlFields
            Changed in place.
        scale : buffer of float64, shape (nq,)
            Size of a unit of each coordinate, m.
        t_end : float
            Time that is the end of a step, s.
        most_steps : int
            After so many accepted steps the call returns.
        times : buffer of float64, shape (n,)
            Times to record at, ascending.
        sensors, positions : writable buffers of float64, shape (n, ns) and (n, nq)
            Take the records; either may be None.
        done : int
            Rows that are already written.

        Returns
        -------
        int
            Rows written, those before included.
        """
        sizes, n = self.system.sizes, memoryview(times).nbytes // 8
        rows = (
            buffer(times, n, "times", writable=False),
            buffer(sensors, n * sizes.ns, "sensors", writable=True),
            buffer(positions, n * sizes.nq, "positions", writable=True),
        )
        record = RecordFields(n, *(None if r is None else ctypes.cast(r, POINTER(c_double)) for r in rows))
        written = c_int64(done)
        lengths = buffer(scale, sizes.nq, "scale", writable=False)
        status = self._library.ali3_control_run(
            self._handle, byref(control), lengths, t_end, most_steps, byref(record), byref(written)
        )
        self._check(status)
        return written.value

    def refresh(self) -> None:
        """Accelerations and multipliers of the present inputs and guides, without a past: after a jump of theirs."""
        self._check(self._library.ali3_refresh(self._handle))

    def follow(self, other: Instance) -> None:
        """Take over the state of the same model without ports, and find the forces at the ports, for `sensors`.

        `other`: initialised; stays as it is. This System has the map of `mbs.compiler.ports.with_ports_of`.
        """
        self._check(self._library.ali3_ports_follow(self._handle, other._handle))

    def balance_wrong(self) -> bool:
        """Whether the energy balance says that the run is wrong; see ali3_report.balance."""
        return bool(self._report().balance == Balance.WRONG)

    def branch_text(self) -> str:
        """A sentence about the first change of the assembly mode of a closed loop; empty where there was none."""
        return self._text(self._library.ali3_branch_text)

    def rim_text(self) -> tuple[int, str]:
        """The element whose rim was pressed deepest into a road and a sentence on it; -1 and none where none was."""
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
        """All that continues bit for bit."""
        data = ctypes.create_string_buffer(self.system.state_size)
        self._check(self._library.ali3_state_save(self._handle, data, len(data)))
        return data.raw

    def restore(self, data: bytes) -> None:
        """Continue from saved bytes of the same System; altered bytes are refused."""
        self._check(self._library.ali3_state_restore(self._handle, bytes(data), len(data)))

    def snapshot(self) -> Any:
        """A copy in memory of the state, for `at` of this instance: at less cost than `save`."""
        data = ctypes.create_string_buffer(self.system.snapshot_size)
        self._library.ali3_snapshot_take(self._handle, data)
        return data

    @contextmanager
    def at(self, snapshot: Any) -> Iterator[None]:
        """Go back to a snapshot of this instance, and return to the present state."""
        now = self.snapshot()
        self._library.ali3_snapshot_restore(self._handle, snapshot)
        try:
            yield
        finally:
            self._library.ali3_snapshot_restore(self._handle, now)

    def evaluate(
        self, q: Sequence[float], qd: Sequence[float], y: Sequence[float] | None = None, t: float | None = None
    ) -> dict[str, Any]:
        """Rows, forces and element outputs at given values; the state stays.

        Result: `phi`, `phi_t`, `gamma` (nc,), `jacobian` (nnz_rows,) of the stored rows, `force` (nq,), `outputs`
        (nout,).
        """
        s = self.system.sizes
        counts = {"phi": s.nc, "jacobian": s.nnz_rows, "phi_t": s.nc, "gamma": s.nc, "force": s.nq, "outputs": s.nout}
        values = {name: (c_double * n)() for name, n in counts.items()}
        given = (numbers(q, s.nq, "q"), numbers(qd, s.nq, "qd"), numbers(y, s.ny, "y"))
        time = self.time if t is None else t
        self._check(self._library.ali3_evaluate(self._handle, *given, time, *values.values()))
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
        """Element states (ny,) after `h` seconds at held q, qd, and the generalised force (nq,) with them."""
        s = self.system.sizes
        y_new, force = (c_double * s.ny)(), (c_double * s.nq)()
        given = (numbers(q, s.nq, "q"), numbers(qd, s.nq, "qd"), numbers(y_old, s.ny, "y_old"))
        self._check(self._library.ali3_element_step(self._handle, *given, h, y_new, force))
        return y_new, force
