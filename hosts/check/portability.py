"""Checks of what breaks one host and not another: types, units, dependencies, time, careless calls, long steps."""

from __future__ import annotations

import threading
from collections import Counter
from ctypes import byref, c_bool, c_double, c_int, c_void_p
from xml.etree import ElementTree

from hosts.check.instance import Finding, Instance, Subject, count_of

# Names whose last part says that the value is a whole number.
_COUNTS = ("iterations", "factorizations", "halvings", "status", "gear", "fidelity")
_LICENCES = ("license.txt", "license.html", "license.spdx")
_FAR = 1e16
_INNER_STEPS = 1e9
_PATIENCE = 20.0
_OK, _ERROR, _SHORT_STEP = 0, 3, 0.5
_DISCARD, _TRIES, _COARSE, _STRONG = 2, 40, 10, 100.0
_DO_STEP_STATUS = 0


def one_spelling(subject: Subject) -> Finding:
    """Units that are equal under two names."""
    spelt = [u.name for u in subject.description.unitDefinitions]
    twice = [name for name, count in Counter(map(_plain, spelt)).items() if count > 1]
    if twice:
        both = " and ".join(f"'{name}'" for name in spelt if _plain(name) == twice[0])
        return Finding("unit names", "bad", f"one unit under two names: {both}")
    return Finding("unit names", "good", f"{len(spelt)}, each under one name")


def _plain(unit: str) -> str:
    return unit.replace("·", ".").replace("*", ".").replace(" ", ".").replace("^", "")


def whole_numbers(subject: Subject) -> Finding:
    """Counts and levels that are real numbers."""
    found = [
        v.name
        for v in subject.description.modelVariables
        if v.type in ("Real", "Float64") and v.name.rpartition(".")[2] in _COUNTS
    ]
    if found:
        return Finding("whole numbers", "bad", f"{len(found)} counts or levels are real numbers, such as {found[0]}")
    return Finding("whole numbers", "good", "counts and levels are integers")


def about_the_file(subject: Subject) -> Finding:
    """Rights, date, descriptions, typical sizes, dependencies of the initial state."""
    root = ElementTree.parse(subject.folder / "modelDescription.xml").getroot()
    missing = [name for name in ("author", "copyright", "license") if not root.get(name)]
    words = [f"no {', '.join(missing)}"] if missing else []
    if not any((subject.folder / "documentation" / "licenses" / name).exists() for name in _LICENCES):
        words.append("no documentation/licenses/license.txt")
    if root.get("generationDateAndTime", "").startswith(("2000-01-01", "1970-01-01", "1980-01-01")):
        words.append(f"made on {root.get('generationDateAndTime')}")
    variables = subject.description.modelVariables
    shared = [text for text, count in Counter(v.description for v in variables).items() if text and count > 1]
    if shared:
        words.append(f"{len(shared)} descriptions stand at several variables, such as '{shared[0]}'")
    if not any(v.nominal is not None for v in variables):
        words.append("no typical sizes (nominal)")
    unknowns = subject.description.initialUnknowns
    initial = [u.dependencies for u in unknowns if u.dependencies]
    if len(initial) > 8 and all(len(d) == len(initial[0]) > 1 for d in initial):
        words.append("every initial output is said to depend on everything")
    if words:
        return Finding("about the file", "bad", "; ".join(words))
    left_out = sum(u.dependencies is None for u in unknowns)
    told = (
        f"{left_out} of {len(unknowns)} initial outputs depend on all that is set"
        if left_out
        else "sparse dependencies"
    )
    return Finding("about the file", "good", f"rights, date, distinct descriptions, typical sizes; {told}")


def build_files(subject: Subject) -> Finding:
    """Whether sources of FMI 3.0 that use the mathematical library say so."""
    sources = subject.folder / "sources"
    description = sources / "buildDescription.xml"
    used = any("#include <math.h>" in f.read_text(encoding="utf-8", errors="replace") for f in sources.rglob("*.c"))
    if not (subject.three and used):
        return Finding("build description", "good", "not needed")
    named = description.exists() and any(
        e.get("name") == "m" for e in ElementTree.parse(description).getroot().iter("Library")
    )
    words = (
        "names the mathematical library" if named else "the sources use the mathematical library, which is not named"
    )
    return Finding("build description", "good" if named else "bad", words)


def time_anywhere(subject: Subject) -> Finding:
    """FMI 3.0: the variable time beside others, and twice."""
    time = [v for v in subject.description.modelVariables if v.causality == "independent"]
    single = [v for v in subject.outputs if v.type == "Float64" and not v.dimensions]
    if not subject.three or not time:
        return Finding("time", "good", "no variable of its own")
    instance = Instance(subject).start()
    instance.run(2)
    t = time[0].valueReference
    references = [t, *(v.valueReference for v in single[:1]), t]
    try:
        values = instance.slave.getFloat64(references)
    except Exception as error:
        return Finding("time", "bad", f"cannot be read with other variables, or twice: {error}")
    good = abs(values[0] - 2.0 * subject.step) < 1e-9 and values[0] == values[-1]
    return Finding("time", "good" if good else "bad", "beside other variables and twice" if good else f"reads {values}")


def dependencies(subject: Subject) -> Finding:
    """Whether outputs are said to depend on the inputs by which they have a derivative."""
    face = ElementTree.parse(subject.folder / "modelDescription.xml").getroot().find("CoSimulation")
    name = "providesDirectionalDerivatives" if subject.three else "providesDirectionalDerivative"
    if face is None or face.get(name) != "true" or not subject.inputs:
        return Finding("dependencies", "good", "no derivatives to compare with")
    declared = {
        u.variable.name: None if u.dependencies is None else {v.name for v in u.dependencies}
        for u in subject.description.outputs
    }
    outputs = [v for v in subject.outputs if v.type in ("Real", "Float64")]
    names_of_slopes = [v.name for v in outputs for _ in range(count_of(v))]
    whole = {v.valueReference: v.name for v in subject.description.modelVariables}
    instance = Instance(subject).start()
    instance.run(max(2, subject.steps // 2))
    for known in subject.inputs:
        place = subject.places[known.name]
        seed = [float(k == place.item) for k in range(place.size)]
        arguments = ([v.valueReference for v in outputs], [place.reference], seed)
        try:
            if subject.three:
                slopes = instance.slave.getDirectionalDerivative(*arguments, len(names_of_slopes))
            else:
                slopes = instance.slave.getDirectionalDerivative(*arguments)
        except Exception as error:
            return Finding("dependencies", "note", f"no derivative by {known.name}: {error}")
        for name, slope in zip(names_of_slopes, slopes, strict=True):
            names = declared.get(name)
            if slope != 0.0 and names is not None and whole[place.reference] not in names:
                words = f"{name} has a derivative by {known.name}, on which it is said not to depend"
                return Finding("dependencies", "bad", words)
    return Finding("dependencies", "good", "outputs have derivatives only by inputs they are said to depend on")


def quiet_steps(subject: Subject) -> Finding:
    """A communication step of half the default one is no warning."""
    if not subject.description.coSimulation.canHandleVariableCommunicationStepSize:
        return Finding("quiet steps", "good", "only the one step size is allowed")
    status = _step_status(Instance(subject).start(), 0.0, _SHORT_STEP * subject.step)
    if status != _OK:
        return Finding("quiet steps", "bad", f"half the default step is answered with status {status}")
    return Finding("quiet steps", "good", "half the default step is no warning")


def careless_calls(subject: Subject) -> Finding:
    """An empty name, an unknown log category, values too early, a step beyond the end: refused; the status reported."""
    taken = []
    try:
        Instance(subject, name="")
        taken.append("an empty instance name")
    except Exception:
        pass
    early = Instance(subject)
    real = [v for v in subject.outputs if v.type in ("Real", "Float64")][:1]
    for what, call in (
        ("values before initialisation", lambda: early.get(real)),
        ("an unknown log category", lambda: early.slave.setDebugLogging(True, ["logNoSuchThing"])),
    ):
        try:
            call()
            taken.append(what)
        except Exception:
            continue
    ended = Instance(subject).start(stop_time=2.0 * subject.step)
    if _step_status(ended, 0.0, 3.0 * subject.step) < _ERROR:
        taken.append("a step beyond the stop time")
    if not subject.three:
        try:
            if ended.slave.getStatus(_DO_STEP_STATUS) != _ERROR:
                taken.append("fmi2GetStatus returns another status than the last step had")
        except Exception:
            taken.append("fmi2GetStatus does not return the status of the last step")
    if taken:
        return Finding("careless calls", "bad", f"accepted without a message: {', '.join(taken)}")
    return Finding("careless calls", "good", "empty names, unknown categories, early reads and late steps are refused")


def capital_scheme(subject: Subject) -> Finding:
    """The scheme of a URI may be written in capitals."""
    if subject.three:
        return Finding("resources", "good", "FMI 3.0 gives a path")
    uri = (subject.folder / "resources").as_uri()
    try:
        Instance(subject, resources="FILE" + uri.removeprefix("file"))
    except MemoryError:
        raise
    except Exception:
        return Finding("resources", "bad", "a location that begins with FILE:// is refused")
    return Finding("resources", "good", "the scheme of their location may be in capitals")


def arrays(subject: Subject) -> Finding:
    """FMI 3.0: variables with dimensions, which some hosts read as zeros without a message."""
    found = [v.name for v in subject.description.modelVariables if getattr(v, "dimensions", None)]
    if found:
        words = f"{len(found)} variables are arrays, such as {found[0]}; some hosts read them as zeros silently"
        return Finding("arrays", "note", words)
    return Finding("arrays", "good", "every variable is a scalar")


def refused_steps(subject: Subject) -> Finding:
    """A host that asks for a refused step again and again is stopped."""
    instance = Instance(subject).start()
    for k in range(_TRIES):
        for v in subject.inputs:
            instance.set_input(v, float(v.max if v.max is not None else _STRONG))
        time, step = k * _COARSE * subject.step, _COARSE * subject.step
        statuses = [_step_status(instance, time, step)]
        if statuses[0] != _DISCARD:
            if statuses[0] > _DISCARD:
                break
            continue
        statuses += [_step_status(instance, time, step) for _ in range(2)]
        if statuses[-1] < _ERROR:
            return Finding("refused steps", "bad", f"a refused step at {time:g} s can be asked for without end")
        return Finding("refused steps", "good", f"a step refused at {time:g} s is an error the third time")
    return Finding("refused steps", "good", "none was refused with strong inputs")


def far_clock(subject: Subject) -> Finding:
    """Where the clock cannot follow a step, it is refused."""
    instance = Instance(subject)
    try:
        instance.start(start_time=_FAR)
    except Exception:
        return Finding("far from zero", "good", f"a start at {_FAR:g} s is refused")
    status = _step_status(instance, _FAR, subject.step)
    if status < _ERROR:
        return Finding("far from zero", "bad", f"a step of {subject.step:g} s at {_FAR:g} s is taken, its clock stands")
    return Finding("far from zero", "good", f"a step of {subject.step:g} s at {_FAR:g} s is refused")


def long_steps(subject: Subject) -> Finding:
    """A communication step that would take hours comes back."""
    instance, answers = Instance(subject).start(), []
    length = _INNER_STEPS * 0.999 * subject.step
    worker = threading.Thread(target=lambda: answers.append(_step_status(instance, 0.0, length)), daemon=True)
    worker.start()
    worker.join(_PATIENCE)
    if worker.is_alive():
        return Finding("long steps", "bad", f"a step of {length:g} s has not come back after {_PATIENCE:g} s")
    return Finding("long steps", "good", f"a step of {length:g} s is answered at once with status {answers[0]}")


def _step_status(instance: Instance, time: float, step: float) -> int:
    """Status of a step, a warning too, which FMPy passes over."""
    slave, begin, length = instance.slave, c_double(time), c_double(step)
    if not instance.three:
        return int(slave.dll.fmi2DoStep(c_void_p(slave.component), begin, length, c_int(1)))
    pointers = [*(byref(c_bool()) for _ in range(3)), byref(c_double())]
    return int(slave.dll.fmi3DoStep(c_void_p(slave.component), begin, length, c_bool(True), *pointers))


PORTABILITY_CHECKS = (
    ("unit names", one_spelling),
    ("whole numbers", whole_numbers),
    ("about the file", about_the_file),
    ("build description", build_files),
    ("time", time_anywhere),
    ("dependencies", dependencies),
    ("quiet steps", quiet_steps),
    ("careless calls", careless_calls),
    ("resources", capital_scheme),
    ("arrays", arrays),
    ("refused steps", refused_steps),
    ("far from zero", far_clock),
    ("long steps", long_steps),
)
