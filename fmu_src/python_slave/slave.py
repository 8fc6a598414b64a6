"""The co-simulation slave: System file, compiled kernel, table of variables. It runs inside the FMU, without numpy.

PythonFMU turns every exception into fmi2Fatal. So nothing here raises on account of a host's mistake: a refused call
is logged with the status it deserves, and the shell around PythonFMU (`shell.c`) hands that to the host.
"""

from __future__ import annotations

import json
import math
import struct
import sys
import zlib
from pathlib import Path
from typing import Any

from . import binding
from .pythonfmu.enums import Fmi2Status
from .pythonfmu.fmi2slave import Fmi2Slave

_HERE = Path(__file__).parent
_STATE_MAGIC = b"ALI3FMU3"
_STATE_HEAD = struct.Struct("<8s16sIIdd")
_LOWEST, _HIGHEST = -(2**31), 2**31 - 1
_CHECKSUM = struct.Struct("<I")
_INSTANTIATED, _INITIALISING, _STEPPING, _TERMINATED = range(4)
_STATUS, _BALANCE = 5, 7  # ALI3_SOLVER_STATUS, ALI3_SOLVER_ENERGY_BALANCE
_POSE_HEIGHT, _POSE_SPEED = 2, 4  # places in a pose
_PHASE_NAMES = ("before initialisation", "in initialisation", "after initialisation", "after termination")
# A host adds up its time in floating point; it may be this much off, s.
_TIME_TOLERANCE = 1e-6
# End points this near (in steps) are reached with the tuned step itself.
_STEP_TOLERANCE = 1e-6
_STEP_DEVIATION = 0.05
# In one call, which cannot be cancelled.
_MOST_STEPS = 1e6
# Neighbouring times are not farther apart than this share of an inner step.
_CLOCK_TOLERANCE = 1e-3


def _bytes_of(file: Path) -> bytes:
    """Content of a file; a named pipe would wait for its writer."""
    if not file.is_file():
        raise FileNotFoundError(f"{file} is no file.")
    return file.read_bytes()


class _Shared:
    """What all instances of one FMU share: the library, the Systems and the table; none of it changes."""

    _instance: _Shared | None = None

    def __init__(self) -> None:
        description = json.loads((_HERE / "fmu.json").read_text(encoding="utf-8"))
        self.rows: list[list[str]] = description["rows"]
        self.table: list[dict[str, Any]] = description["variables"]
        self.identity = bytes.fromhex(description["identity"])[:16]
        folder = _HERE / ("win64" if sys.platform == "win32" else "linux64")
        library = next(folder.iterdir())
        # All at once: a host may remove this folder while a later instance, unpacked elsewhere, shares this module.
        self.systems = [
            binding.LoadedSystem(_bytes_of(_HERE / f"system_{k}.ali3"), library) for k in range(len(self.rows))
        ]

    @classmethod
    def get(cls) -> _Shared:
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance


class Slave(Fmi2Slave):
    """One instance of the System behind the calls of FMI 2.0 co-simulation."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        # PythonFMU puts the resources before the host's own path at each instantiation and leaves them there.
        sys.path[:] = [place for place in sys.path if place != kwargs["resources"]]
        shared = _Shared.get()
        self._identity = shared.identity
        self._table = shared.table
        self._n_known = sum(v["causality"] != "output" for v in self._table)
        # Values by value reference; the outputs are filled when they are asked for.
        self._values = [0.0 if v["start"] is None else v["start"] for v in self._table]
        self._solver = [v["index"] for v in self._table if v["source"] == "solver"]
        self._step_reference = next(i for i, v in enumerate(self._table) if v["source"] == "step_size")
        self._fidelity_reference = next((i for i, v in enumerate(self._table) if v["source"] == "fidelity"), None)
        self._fidelity = self._wanted_fidelity(self._values)
        self._kernel = binding.Instance(shared.systems[self._fidelity])
        self._parameters = {i for i, v in enumerate(self._table) if v["source"] == "parameter"}
        self._pending: set[int] = set()
        self._clamped: set[int] = set()
        self._phase = _INSTANTIATED
        self._start_time = 0.0
        self._stop_time = math.inf
        self._outputs_fresh = False
        self._initialised = False
        self._step_warned = False
        self._energy_warned = False
        self._mode_warned = False

    # Calls of the host, in their usual order

    def setup_experiment(
        self, start_time: float, stop_time: float | None = None, tolerance: float | None = None
    ) -> None:
        if self._phase != _INSTANTIATED:
            self._refuse(f"fmi2SetupExperiment is not allowed {_PHASE_NAMES[self._phase]}.")
        elif not math.isfinite(start_time):
            self._refuse(f"The start time is {start_time}; a finite number is needed.")
        elif stop_time is not None and not stop_time > start_time:
            self._refuse(f"The stop time {stop_time:g} s does not lie after the start time {start_time:g} s.")
        else:
            self._start_time = float(start_time)
            self._stop_time = math.inf if stop_time is None else float(stop_time)
            self._stale()

    def enter_initialization_mode(self) -> None:
        if self._phase != _INSTANTIATED:
            self._refuse(f"fmi2EnterInitializationMode is not allowed {_PHASE_NAMES[self._phase]}.")
        else:
            self._phase = _INITIALISING

    def exit_initialization_mode(self) -> None:
        if self._phase != _INITIALISING:
            self._refuse(f"fmi2ExitInitializationMode is not allowed {_PHASE_NAMES[self._phase]}.")
        elif self._initialise():
            self._phase = _STEPPING

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance to ``current_time + step_size`` in equal inner steps, or not at all.

        Parameters
        ----------
        current_time, step_size : float
            Communication point and step, s.

        Returns
        -------
        bool
            False if the step is refused; then the state is the one before the call.
        """
        if self._phase != _STEPPING:
            return self._refuse(f"fmi2DoStep is not allowed {_PHASE_NAMES[self._phase]}.")
        kernel = self._kernel
        time = kernel.time
        problem = self._impossible(current_time, step_size, time)
        if problem:
            return self._refuse(problem)
        n, h = self._division(time, current_time + step_size)
        # One step keeps the last state when it fails; several, or a changed parameter, must be taken back together.
        saved = kernel.save() if n > 1 or self._pending & self._parameters else None
        inputs = {vr: kernel.get_input(self._table[vr]["index"]) for vr in self._pending - self._parameters}
        try:
            self._apply_pending()
            if n == 1:
                kernel.step(h)
            else:
                kernel.run(h, n)
        except Exception as error:
            worst = self._worst()
            if saved is not None:
                kernel.restore(saved)
            for vr, value in inputs.items():
                kernel.set_input(self._table[vr]["index"], value)
            return self._discard(
                f"The step from {time:.6g} s over {step_size:.6g} s was refused, "
                f"the state at {time:.6g} s is kept: {error}{worst} A smaller step_size may pass: it is "
                f"{self._values[self._step_reference]:g} s and can be set before initialisation."
            )
        self._pending.clear()
        self._outputs_fresh = False
        self._watch_modes()
        self._watch()
        return True

    def _impossible(self, time: float, step: float, now: float) -> str:
        """Why a step cannot be asked for here at all; empty if it can."""
        inner = self._values[self._step_reference]
        if not (math.isfinite(time) and math.isfinite(step) and step > 0.0):
            return f"A step from {time:g} s over {step:g} s: a finite time and a positive step are needed."
        if abs(time - now) > _TIME_TOLERANCE:
            return f"The step starts at {time:.10g} s, but this instance stands at {now:.10g} s."
        if time + step > self._stop_time + _TIME_TOLERANCE:
            return f"The step from {time:g} s over {step:g} s goes beyond the stop time {self._stop_time:g} s."
        if step / inner > _MOST_STEPS:
            return (
                f"The step of {step:g} s has more than {_MOST_STEPS:g} inner steps of {inner:g} s and could not be "
                "cancelled; ask for shorter ones."
            )
        apart = abs(time) * sys.float_info.epsilon
        if not time + step > time or apart > _CLOCK_TOLERANCE * inner:
            return (
                f"At {time:g} s neighbouring times are {apart:.2g} s apart: the clock cannot follow a step of {step:g} "
                f"s with inner steps of {inner:g} s; begin nearer to zero."
            )
        return ""

    def _watch_modes(self) -> None:
        """A closed loop that changed its assembly mode, once."""
        if self._mode_warned or self._kernel.solver_value(_STATUS) != binding.Status.BRANCH_CHANGED:
            return
        self._mode_warned = True
        self.log(f"{self._kernel.branch_text()} This is said once.", Fmi2Status.warning)

    def _watch(self) -> None:
        """What a run says about itself after a step, once: that its numbers are not what was asked."""
        doubt = binding.Doubt.NONE if self._energy_warned else self._kernel.doubt()
        if doubt == binding.Doubt.NONE:
            return
        self._energy_warned = True
        report, time, h = self._kernel.report(), self._kernel.time, self._values[self._step_reference]
        if doubt == binding.Doubt.BALANCE:
            balance = self._kernel.solver_value(_BALANCE)
            text = (
                f"At {time:.6g} s the steps have made or lost {report['energy_error']:.3g} J where no force did, "
                f"{100.0 * balance:.2g} % of the energy in the motion: the results are not to be relied on. Run anew "
                f"with a step_size below {h:g} s. This is said once."
            )
        else:
            text = (
                f"Up to {time:.6g} s the solver had to halve its step {report['halvings']} times in {report['steps']} "
                "steps: the motion is too fast for step_size. Compare with a run of half the step_size, "
                f"{0.5 * h:g} s. This is said once."
            )
        self.log(text, Fmi2Status.warning)

    def terminate(self) -> None:
        if self._phase != _STEPPING:
            self._refuse(f"fmi2Terminate is not allowed {_PHASE_NAMES[self._phase]}.")
        else:
            self._phase = _TERMINATED

    # Values

    def get_real(self, vrs: list[int]) -> list[float]:
        if self._phase == _INSTANTIATED:
            self._refuse(f"Values cannot be read {_PHASE_NAMES[self._phase]}.")
            return [math.nan] * len(vrs)
        if not vrs:
            return []
        lowest, highest = min(vrs), max(vrs)
        if lowest < 0 or highest >= len(self._values):
            self._refuse(f"There is no variable with value reference {lowest if lowest < 0 else highest}.")
            return [math.nan] * len(vrs)
        if not self._outputs_fresh and highest >= self._n_known:
            self._evaluate_outputs()
        return list(map(self._values.__getitem__, vrs))

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        # All or nothing: a call with one bad value changes nothing.
        accepted: list[tuple[int, float]] = []
        for vr, value in zip(vrs, values, strict=True):
            checked = self._checked(vr, value)
            if checked is None:
                return
            accepted.append((vr, checked))
        for vr, value in accepted:
            if value == self._values[vr]:
                continue
            self._values[vr] = value
            if self._table[vr]["source"] in ("input", "parameter"):
                self._pending.add(vr)
            if self._phase != _STEPPING:
                self._stale()

    def get_integer(self, vrs: list[int]) -> list[int]:
        if not self._all_whole(vrs):
            return [0] * len(vrs)
        return [0 if math.isnan(x) else int(min(max(x, _LOWEST), _HIGHEST)) for x in self.get_real(vrs)]

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return self._other_type(vrs, False)

    def get_string(self, vrs: list[int]) -> list[str]:
        return self._other_type(vrs, "")

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        if self._all_whole(vrs):
            self.set_real(vrs, [float(value) for value in values])

    def _all_whole(self, vrs: list[int]) -> bool:
        for vr in vrs:
            if not 0 <= vr < len(self._table):
                return self._refuse(f"There is no variable with value reference {vr}.")
            if not self._table[vr]["whole"]:
                return self._refuse(f"'{self._table[vr]['name']}' is a real number, not an integer.")
        return True

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self._other_type(vrs, False)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        self._other_type(vrs, "")

    # The state: the kernel's bytes and the slave's own few values, so that it continues bit for bit anywhere

    def _get_fmu_state(self) -> bytes:
        self._evaluate_if_possible()
        values = self._values
        flags = bytearray(len(values))
        for k in self._pending:
            flags[k] = 1
        head = _STATE_HEAD.pack(
            _STATE_MAGIC,
            self._identity,
            self._phase
            | self._initialised << 2
            | self._outputs_fresh << 3
            | self._step_warned << 4
            | self._energy_warned << 5
            | self._mode_warned << 6,
            len(values),
            self._start_time,
            self._stop_time,
        )
        kernel = self._kernel.save() if self._initialised else b""
        content = head + struct.pack(f"<{len(values)}d", *values) + bytes(flags) + kernel
        return content + _CHECKSUM.pack(zlib.crc32(content))

    def _set_fmu_state(self, state: bytes) -> None:
        n = len(self._values)
        size = _STATE_HEAD.size + 9 * n
        content = bytes(state[: -_CHECKSUM.size])
        if len(content) < size:
            self._refuse("These bytes are not a state of this FMU: they are too short.")
            return
        magic, identity, word, count, start_time, stop_time = _STATE_HEAD.unpack_from(state)
        if magic != _STATE_MAGIC or identity != self._identity or count != n or word >> 7:
            self._refuse("These bytes are not a state of this FMU; only states of the same build can be set.")
            return
        if _CHECKSUM.unpack(state[-_CHECKSUM.size :])[0] != zlib.crc32(content):
            self._refuse("The state was refused: it is damaged, its checksum does not fit.")
            return
        values = list(struct.unpack_from(f"<{n}d", content, _STATE_HEAD.size))
        flags = content[_STATE_HEAD.size + 8 * n : size]
        initialised = bool(word >> 2 & 1)
        if initialised:
            try:
                kernel, fidelity = self._kernel_of(values)
                kernel.restore(content[size:])
            except (binding.KernelError, IndexError, ValueError) as error:
                self._refuse(f"The state was refused: {error}")
                return
            self._kernel, self._fidelity = kernel, fidelity
        self._phase = word & 3
        self._initialised = initialised
        self._outputs_fresh = bool(word >> 3 & 1)
        self._step_warned = bool(word >> 4 & 1)
        self._energy_warned = bool(word >> 5 & 1)
        self._mode_warned = bool(word >> 6 & 1)
        self._start_time = start_time
        self._stop_time = stop_time
        self._values = values
        self._pending = {k for k in range(n) if flags[k]}

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        return bytes(state)

    # Inside

    def _division(self, time: float, end: float) -> tuple[int, float]:
        """Number and size of the equal inner steps from `time` to `end`."""
        step = self._values[self._step_reference]
        n = max(1, round((end - time) / step))
        if abs(time + n * step - end) <= _STEP_TOLERANCE * step:
            return n, step
        h = (end - time) / n
        if abs(h - step) > _STEP_DEVIATION * step and not self._step_warned:
            self._step_warned = True
            self.log(
                f"The communication step {end - time:.6g} s gives inner steps of {h:.6g} s, while step_size is "
                f"{step:.6g} s; results will differ a little. This is said once.",
                Fmi2Status.ok,
                "logStatusWarning",
            )
        return n, h

    def _worst(self) -> str:
        report = self._kernel.report()
        worst = binding.open_row(report, _Shared.get().rows[self._fidelity])
        return f" Worst constraint: {worst}." if worst else ""

    def _start_hint(self, error: Exception) -> str:
        """What is wrong with a start, in numbers."""
        if not isinstance(error, binding.KernelError) or error.status not in (
            binding.Status.BELOW_ROAD,
            binding.Status.TOO_FAR,
        ):
            return self._worst()
        if error.status == binding.Status.TOO_FAR:
            return self._farthest()
        lift = self._kernel.start_lift()
        heights = [k for k, v in enumerate(self._table) if v["source"] == "pose" and v["index"] == _POSE_HEIGHT]
        if not heights:
            return f" {lift:.3g} m higher it would be clear of it."
        name, z = self._table[heights[0]]["name"], self._values[heights[0]]
        return f" '{name}' is {z:g} m; from {z + lift:.3g} m on the tyres are clear of it."

    def _farthest(self) -> str:
        """The start value that lies beyond the digits of a number."""
        text = ""
        for v, value in zip(self._table, self._values, strict=True):
            limits = {_POSE_SPEED: ("m/s", binding.FASTEST)} | dict.fromkeys(range(3), ("m", binding.FARTHEST))
            if v["source"] == "pose" and v["index"] in limits and abs(value) > limits[v["index"]][1]:
                text = f" '{v['name']}' is {value:g} {limits[v['index']][0]}."
        return text

    def _apply_pending(self) -> None:
        for vr in sorted(self._pending):
            v = self._table[vr]
            if v["source"] == "input":
                self._kernel.set_input(v["index"], self._values[vr])
            else:
                self._kernel.set_parameter(v["index"], self._values[vr])

    def _initialise(self) -> bool:
        """Put the kernel at its initial state with the values set so far; False, and logged, if that fails."""
        try:
            self._kernel, self._fidelity = self._kernel_of(self._values)
            kernel = self._kernel
            kernel.reset()
            for v, value in zip(self._table, self._values, strict=True):
                if v["source"] == "input":
                    kernel.set_input(v["index"], value)
                elif v["source"] == "parameter":
                    kernel.set_parameter(v["index"], value)
            pose = [value for v, value in zip(self._table, self._values, strict=True) if v["source"] == "pose"]
            if any(pose):
                kernel.set_pose(*pose)
            kernel.initialise(self._start_time)
        except Exception as error:
            self._initialised = False
            return self._refuse(f"The initial state could not be found: {error}{self._start_hint(error)}")
        self._pending.clear()
        self._initialised = True
        self._outputs_fresh = False
        return True

    def _wanted_fidelity(self, values: list[float]) -> int:
        return 0 if self._fidelity_reference is None else int(values[self._fidelity_reference])

    def _kernel_of(self, values: list[float]) -> tuple[binding.Instance, int]:
        """The kernel for the fidelity among the values: the present one, or a new one of another System."""
        wanted = self._wanted_fidelity(values)
        same = wanted == self._fidelity
        return (self._kernel if same else binding.Instance(_Shared.get().systems[wanted])), wanted

    def _stale(self) -> None:
        self._initialised = False
        self._outputs_fresh = False

    def _evaluate_outputs(self) -> None:
        if not self._initialised and not self._initialise():
            return
        sensors = self._kernel.sensors()[:]
        # The sensors come in their order, then the figures of the solver.
        self._values[self._n_known :] = [*sensors, *map(self._kernel.solver_value, self._solver)]
        self._outputs_fresh = True

    def _evaluate_if_possible(self) -> None:
        # Outputs belong to the end of the last step; a restored instance must show the same ones.
        if self._initialised and not self._outputs_fresh:
            self._evaluate_outputs()

    def _checked(self, vr: int, value: float) -> float | None:
        """The value as it will be used, or None if it is refused."""
        if not 0 <= vr < len(self._table):
            self._refuse(f"There is no variable with value reference {vr}.")
            return None
        v = self._table[vr]
        name, unit = v["name"], "" if v["unit"] == "1" else f" {v['unit']}"
        if v["causality"] == "output":
            self._refuse(f"'{name}' is an output and cannot be set.")
            return None
        if self._phase == _TERMINATED or (v["variability"] == "fixed" and self._phase == _STEPPING):
            self._refuse(f"'{name}' cannot be set {_PHASE_NAMES[self._phase]}.")
            return None
        if not math.isfinite(value):
            self._refuse(
                f"'{name}' was set to {value}; a finite number is needed, "
                f"the last value {self._values[vr]}{unit} is kept."
            )
            return None
        if v["whole"] and value != math.floor(value):
            self._refuse(f"'{name}' was set to {value}; it must be a whole number, it keeps {self._values[vr]:g}.")
            return None
        low = -math.inf if v["min"] is None else v["min"]
        high = math.inf if v["max"] is None else v["max"]
        if low <= value <= high:
            return value
        if v["causality"] == "parameter":
            self._refuse(
                f"'{name}' was set to {value}{unit}, outside its range {low} to {high}; it keeps {self._values[vr]}."
            )
            return None
        clamped = min(max(value, low), high)
        if vr not in self._clamped:
            self._clamped.add(vr)
            self.log(
                f"'{name}' was set to {value}{unit} and is held at {clamped}, the end of its range {low} to {high}. "
                "This is said once.",
                Fmi2Status.warning,
            )
        return clamped

    def _other_type(self, vrs: list[int], value: Any) -> list[Any]:
        if vrs:
            self._refuse("All variables of this FMU are of type Real or Integer.")
        return [value] * len(vrs)

    def _refuse(self, message: str) -> bool:
        self.log(message, Fmi2Status.error)
        return False

    def _discard(self, message: str) -> bool:
        self.log(message, Fmi2Status.discard)
        return False
