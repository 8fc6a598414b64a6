"""The signals of a log that a comparison uses, by its options."""

import argparse
import math
from collections.abc import Mapping
from dataclasses import replace

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.compare.log import Log
from hosts.compare.log_times import MIN_SAMPLES
from hosts.compare.segments import PEDALS
from hosts.fmu.named_fmu import NamedFmu
from hosts.measures.signal import Signal


def selected_signals(
    log: Log, fmu: NamedFmu, options: argparse.Namespace
) -> tuple[dict[str, Signal], dict[str, Signal]]:
    """Inputs and outputs of the log, without those that --signals or --ignore exclude."""
    outputs, inputs = dict(log.outputs), dict(log.inputs)
    if options.signals is not None:
        for name in options.signals:
            if name not in outputs:
                hint = did_you_mean(name, outputs, f"it has {', '.join(outputs) or 'none'}")
                reason = "is not an output of the FMU" if name not in fmu.names("output") else "is not in the log"
                raise HostError(f"--signals: '{name}' {reason}{hint}")
        outputs = {n: outputs[n] for n in options.signals}
    for name in options.ignore:
        if name not in inputs:
            raise HostError(f"--ignore: '{name}' is not an input in the log; it has {', '.join(inputs) or 'none'}.")
        del inputs[name]
    if not outputs:
        raise HostError(
            f"The log {options.log} has no output of {options.fmu.name} to compare; its alias file (--log-aliases) can "
            f"name some of: {', '.join(fmu.names('output')[:12])} ..."
        )
    return inputs, outputs


def speed_to_hold(fmu: NamedFmu, log: Log, inputs: dict[str, Signal], notes: list[str]) -> Signal:
    """The measured speed that a driver is to hold; the pedals of the log are removed from `inputs`."""
    name = next((n for n in ("speed", "chassis.vx") if n in log.outputs), None)
    if name is None:
        raise HostError("--hold-speed needs the speed in the log: an alias for 'speed'.")
    missing = [n for n in (*PEDALS, "speed") if n not in fmu.variables]
    if missing:
        raise HostError(f"--hold-speed needs variables that {fmu.path.name} does not have: {', '.join(missing)}.")
    for pedal in PEDALS:
        inputs.pop(pedal, None)
    notes.append(f"A driver holds the measured {name} by {' and '.join(PEDALS)}; those of the log are not used.")
    return log.outputs[name]


def missing_inputs(
    fmu: NamedFmu, inputs: Mapping[str, Signal], holds_speed: bool, options: argparse.Namespace
) -> list[str]:
    """Inputs of the FMU that nothing drives. Raises `HostError` if the log drives none."""
    names = fmu.names("input")
    if not inputs and not holds_speed:
        raise HostError(
            f"The log {options.log} has no input of {options.fmu.name}, so that there is nothing to replay; its "
            f"inputs are {', '.join(names) or 'none'}: the alias file of the log (--log-aliases) names their columns."
        )
    return [name for name in names if name not in inputs and not (holds_speed and name in PEDALS)]


def outputs_from_begin(log: Log, options: argparse.Namespace) -> dict[str, Signal]:
    """All outputs of the log since time 0, also those that are not compared, for start values."""
    return {n: s for n, s in cut_to_options(log.outputs, options).items() if len(s.time) >= MIN_SAMPLES}


def cut_to_options(signals: Mapping[str, Signal], options: argparse.Namespace) -> dict[str, Signal]:
    """Signals between --from and --to, shifted to begin at 0."""
    begin = options.begin or 0.0
    end = math.inf if options.end is None else options.end
    return cut(signals, begin, end)


def cut(signals: Mapping[str, Signal], begin: float, end: float) -> dict[str, Signal]:
    """Signals between two times, shifted to begin at 0."""
    cut_signals = {n: s.between(begin, end) for n, s in signals.items()}
    return {n: replace(s, time=s.time - begin) for n, s in cut_signals.items()}


def cut_inputs_and_outputs(
    inputs: dict[str, Signal], outputs: dict[str, Signal], options: argparse.Namespace
) -> tuple[dict[str, Signal], dict[str, Signal], float]:
    """Inputs and outputs between --from and --to, shifted to begin at 0, and their last common time, s."""
    last = max(float(s.time[-1]) for s in (inputs or outputs).values())
    for name, value in (("--from", options.begin), ("--to", options.end)):
        if value is not None and not 0.0 <= value <= last:
            raise HostError(f"{name} is {value:g} s; the log's inputs lie between 0 and {last:.6g} s.")
    inputs, outputs = cut_to_options(inputs, options), cut_to_options(outputs, options)
    for signal in (*inputs.values(), *outputs.values()):
        if len(signal.time) < MIN_SAMPLES:
            raise HostError(
                f"The log has {len(signal.time)} samples of '{signal.source}' ({signal.name}) between --from and --to; "
                f"at least {MIN_SAMPLES} are needed."
            )
    end = min(max(float(s.time[-1]) for s in signals.values()) for signals in (inputs or outputs, outputs))
    if not 0.0 <= options.skip < 0.9 * end:
        raise HostError(f"--skip is {options.skip:g} s; the log lasts {end:.6g} s.")
    return inputs, outputs, end
