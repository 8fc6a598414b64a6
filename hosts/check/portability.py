"""Checks of what breaks one host and not another: types, units, time, careless calls, long steps."""

import os
import shutil
from collections import Counter
from collections.abc import Callable
from ctypes import byref, c_bool, c_double, c_int, c_void_p
from xml.etree import ElementTree

from ali3.call_mark import marked
from hosts.check.instance import NOT_ALLOWED, REAL, Finding, Instance, NotInstantiatedError, Subject, check

# Last parts of names of variables that are whole numbers.
_COUNTS = ("iterations", "factorizations", "halvings", "status", "gear", "fidelity")
_LICENCES = ("license.txt", "license.html", "license.spdx")
_FAR_TIME = 1e16
_INNER_STEPS = 1e9
_NO_LIMIT = "FMI sets no time for a step: FMI 2.0, 4.2.2, and FMI 3.0, 4.2.1"
_OK = 0
_WARNING = 1
_ERROR = 3
_SHORT_STEP = 0.5
_DISCARD = 2
_REFUSABLE_STEPS = 40
_COARSE_STEP = 10
_STRONG_INPUT = 100.0


@check("unit names", calls=False)
def check_unit_names(subject: Subject) -> Finding:
    """Whether no unit has two names."""
    unit_names = [u.name for u in subject.description.unitDefinitions]
    repeated = [name for name, count in Counter(map(_unit_key, unit_names)).items() if count > 1]
    if repeated:
        names = " and ".join(f"'{name}'" for name in unit_names if _unit_key(name) == repeated[0])
        message = f"one unit under two names: {names}; FMI asks for different names only"
        return Finding("note", f"{message} {subject.clause('2.2.2', '2.4.3')}")
    return Finding("good", f"{len(unit_names)}, each under one name")


def _unit_key(unit: str) -> str:
    return unit.replace("·", ".").replace("*", ".").replace(" ", ".").replace("^", "")


@check("whole numbers", calls=False)
def check_whole_numbers(subject: Subject) -> Finding:
    """Whether counts and levels are integers."""
    results = [
        v.name for v in subject.description.modelVariables if v.type in REAL and v.name.rpartition(".")[2] in _COUNTS
    ]
    if results:
        message = f"{len(results)} counts or levels are real numbers, such as {results[0]}; FMI leaves the type open"
        return Finding("note", f"{message} {subject.clause('2.2.7', '2.4.7')}")
    return Finding("good", "counts and levels are integers")


@check("about the file", calls=False)
def check_metadata(subject: Subject) -> Finding:
    """Whether the description has rights, date, distinct descriptions, nominal values and initial dependencies."""
    root = subject.root
    missing = [name for name in ("author", "copyright", "license") if not root.get(name)]
    faults = [f"no {', '.join(missing)}"] if missing else []
    if not any((subject.folder / "documentation" / "licenses" / name).exists() for name in _LICENCES):
        faults.append("no documentation/licenses/license.txt")
    if root.get("generationDateAndTime", "").startswith(("2000-01-01", "1970-01-01", "1980-01-01")):
        faults.append(f"made on {root.get('generationDateAndTime')}")
    variables = subject.description.modelVariables
    shared = [text for text, count in Counter(v.description for v in variables).items() if text and count > 1]
    if shared:
        faults.append(f"{len(shared)} descriptions stand at several variables, such as '{shared[0]}'")
    if not any(v.nominal is not None for v in variables):
        faults.append("no typical sizes (nominal)")
    unknowns = subject.description.initialUnknowns
    initial = [u.dependencies for u in unknowns if u.dependencies]
    if len(initial) > 8 and all(len(d) == len(initial[0]) > 1 for d in initial):
        faults.append("every initial output is said to depend on everything")
    if faults:
        clause = subject.clause("2.2.1, 2.2.7, 2.3", "2.4.1, 2.4.7, 2.5.1")
        return Finding("note", f"{'; '.join(faults)}; all of it is optional {clause}")
    left_out = sum(u.dependencies is None for u in unknowns)
    sentence = (
        f"{left_out} of {len(unknowns)} initial outputs depend on all that is set"
        if left_out
        else "sparse dependencies"
    )
    return Finding("good", f"rights, date, distinct descriptions, typical sizes; {sentence}")


@check("build description", calls=False)
def check_build_description(subject: Subject) -> Finding:
    """Whether the build description of FMI 3.0 names the mathematical library that the sources use."""
    sources = subject.folder / "sources"
    description = sources / "buildDescription.xml"
    uses_mathematics = any(
        "#include <math.h>" in f.read_text(encoding="utf-8", errors="replace") for f in sources.rglob("*.c")
    )
    if not (subject.is_fmi3 and uses_mathematics):
        return Finding("good", "not needed")
    is_named = description.exists() and any(
        e.get("name") == "m" for e in ElementTree.parse(description).getroot().iter("Library")
    )
    if is_named:
        return Finding("good", "names the mathematical library")
    message = "the sources use the mathematical library, which is not named; FMI does not say that it must be"
    return Finding("note", f"{message} {subject.clause('2.3', '2.4.10')}")


@check("time")
def check_time(subject: Subject) -> Finding:
    """Whether the variable time of FMI 3.0 can be read with others and twice in one call."""
    time = [v for v in subject.description.modelVariables if v.causality == "independent"]
    single = [v for v in subject.outputs if v.type == "Float64" and not v.dimensions]
    if not subject.is_fmi3 or not time:
        return Finding("good", "no variable of its own")
    instance = Instance(subject).start()
    instance.run(2)
    t = time[0].valueReference
    references = [t, *(v.valueReference for v in single[:1]), t]
    try:
        values = instance.slave.getFloat64(references)
    except Exception as error:
        return Finding("bad", f"cannot be read with other variables, or twice: {error}")
    if abs(values[0] - 2.0 * subject.step) < 1e-9 and values[0] == values[-1]:
        return Finding("good", "beside other variables and twice")
    message = (
        f"reads {values[0]:.9g} s and {values[-1]:.9g} s after a step to {2.0 * subject.step:.9g} s (FMI 3.0, 4.2.1)"
    )
    return Finding("bad", message)


@check("quiet steps")
def check_short_step(subject: Subject) -> Finding:
    """Whether a communication step of half the default one gives no warning."""
    if not subject.description.coSimulation.canHandleVariableCommunicationStepSize:
        return Finding("good", "only the one step size is allowed")
    instance = Instance(subject).start()
    status = _step_status(instance, 0.0, _SHORT_STEP * subject.step)
    if status == _WARNING and not instance.messages:
        message = "a step is answered with a warning and without a message; say what it warns of"
        return Finding("bad", f"{message} {subject.clause('2.1.3', '2.2.4')}")
    if status != _OK:
        message = f"half the default step is answered with status {status}, which FMI leaves to the FMU"
        return Finding("note", f"{message} {subject.clause('2.1.3', '2.2.4')}")
    return Finding("good", "half the default step causes no warning")


@check("careless calls", crash="note", late="note", clause=NOT_ALLOWED)
def check_careless_calls(subject: Subject) -> Finding:
    """Whether an empty name, an unknown log category and reads before initialisation are refused.

    FMI does not require it; an FMU of FMI 3.0 may give start values before its initialisation.
    """
    accepted = []
    try:
        Instance(subject, name="")
        accepted.append("an empty instance name")
    except Exception:
        pass
    early = Instance(subject)
    real = [v for v in subject.outputs if v.type == "Real"][:1]
    calls: list[tuple[str, Callable[[], object]]] = [
        ("an unknown log category", lambda: early.slave.setDebugLogging(True, ["logNoSuchThing"])),
        *([("values before initialisation", lambda: early.get(real))] if real else []),
    ]
    for label, call in calls:
        try:
            call()
            accepted.append(label)
        except Exception:
            continue
    if accepted:
        message = f"accepted without a message: {', '.join(accepted)}; FMI does not say what an FMU does"
        return Finding("note", f"{message} {subject.clause('2.1.5, 4.2.4', '2.3.1')}")
    return Finding("good", "empty names, unknown categories and early reads are refused")


@check("stop time")
def check_stop_time(subject: Subject) -> Finding:
    """Whether a step beyond a stop time that was set is an error; few exporters do so, and no host relies on it."""
    ended = Instance(subject).start(stop_time=2.0 * subject.step)
    ended.run(1)
    status = _step_status(ended, subject.step, 2.0 * subject.step)
    if status < _ERROR:
        message = f"a step beyond it is answered with status {status}, where an error is asked for"
        return Finding("note", f"{message} {subject.clause('2.1.6', '2.3.3')}; stop at it in the host")
    return Finding("good", "a step beyond it is refused")


@check("resource paths")
def check_resource_path(subject: Subject) -> Finding:
    """Whether the path of the resources may have blanks and characters outside ASCII."""
    folder = subject.folder / "of a user, m\u00fcller"
    source = subject.folder / "resources"
    if not folder.exists():
        shutil.copytree(source, folder) if source.is_dir() else folder.mkdir()
    try:
        Instance(subject, resources=f"{folder}{os.sep}" if subject.is_fmi3 else folder.as_uri())
    except NotInstantiatedError:
        message = f"it is not instantiated with resources in a folder named '{folder.name}'; decode their location"
        return Finding("bad", f"{message} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", "spaces and non-ASCII letters are accepted")


@check("resources", crash="note", clause="capitals of a scheme are of RFC 3986, 3.1")
def check_uri_scheme(subject: Subject) -> Finding:
    """Whether the scheme of a URI may be written in capitals."""
    if subject.is_fmi3:
        return Finding("good", "FMI 3.0 gives a path")
    uri = (subject.folder / "resources").as_uri()
    Instance(subject, resources=uri)
    try:
        Instance(subject, resources="FILE" + uri.removeprefix("file"))
    except MemoryError:
        raise
    except Exception:
        message = "a location that begins with FILE:// is refused; schemes should be taken in capitals (RFC 3986, 3.1)"
        return Finding("note", message)
    return Finding("good", "the scheme of their location may be in capitals")


@check("arrays", calls=False)
def check_arrays(subject: Subject) -> Finding:
    """Whether all variables are scalars; some hosts read arrays of FMI 3.0 as zeros without a message."""
    results = [v.name for v in subject.description.modelVariables if getattr(v, "dimensions", None)]
    if results:
        message = f"{len(results)} variables are arrays, such as {results[0]}; some hosts read them as zeros silently"
        return Finding("note", message)
    return Finding("good", "every variable is a scalar")


@check("refused steps", late="note", clause=_NO_LIMIT)
def check_refused_steps(subject: Subject) -> Finding:
    """Whether a step that was refused several times becomes an error, so that a host does not repeat it endlessly."""
    instance = Instance(subject).start()
    for k in range(_REFUSABLE_STEPS):
        for v in subject.inputs:
            instance.set_input(v, float(v.max if v.max is not None else _STRONG_INPUT))
        time, step = k * _COARSE_STEP * subject.step, _COARSE_STEP * subject.step
        statuses = [_step_status(instance, time, step)]
        if statuses[0] != _DISCARD:
            if statuses[0] > _DISCARD:
                break
            continue
        statuses += [_step_status(instance, time, step) for _ in range(2)]
        if statuses[-1] < _ERROR:
            message = f"a refused step at {time:g} s can be asked for without end, which FMI leaves to the host"
            return Finding("note", f"{message} {subject.clause('2.1.3', '4.2.1')}")
        return Finding("good", f"a step refused at {time:g} s is an error the third time")
    return Finding("good", "none was refused with strong inputs")


@check("far from zero", late="note", clause=_NO_LIMIT)
def check_far_time(subject: Subject) -> Finding:
    """Whether a step that is lost in the round-off of the time is refused."""
    instance = Instance(subject)
    try:
        instance.start(start_time=_FAR_TIME)
    except Exception:
        return Finding("good", f"a start at {_FAR_TIME:g} s is refused")
    status = _step_status(instance, _FAR_TIME, subject.step)
    if status < _ERROR:
        step = f"a step of {subject.step:g} s at {_FAR_TIME:g} s"
        message = f"{step} is accepted, but its time does not change; FMI does not define this"
        return Finding("note", f"{message} {subject.clause('4.2.2', '4.2.1')}")
    return Finding("good", f"a step of {subject.step:g} s at {_FAR_TIME:g} s is refused")


@check("long steps", late="note", clause=_NO_LIMIT)
def check_long_step(subject: Subject) -> Finding:
    """Whether the FMU answers a communication step that would take hours."""
    length = _INNER_STEPS * 0.999 * subject.step
    status = _step_status(Instance(subject).start(), 0.0, length)
    return Finding("good", f"a step of {length:g} s is answered in time, with status {status}")


def _step_status(instance: Instance, time: float, step: float) -> int:
    """Status of a step; FMPy does not report warnings."""
    slave, begin, length = instance.slave, c_double(time), c_double(step)
    if not instance.is_fmi3:
        fmi2_do_step = marked("fmi2DoStep", slave.dll.fmi2DoStep)
        return int(fmi2_do_step(c_void_p(slave.component), begin, length, c_int(1)))
    fmi3_do_step = marked("fmi3DoStep", slave.dll.fmi3DoStep)
    pointers = [*(byref(c_bool()) for _ in range(3)), byref(c_double())]
    return int(fmi3_do_step(c_void_p(slave.component), begin, length, c_bool(True), *pointers))
