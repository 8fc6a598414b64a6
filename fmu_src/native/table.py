"""The C table of an FMU, made from the table of variables."""

from collections.abc import Mapping, Sequence
from itertools import accumulate

from ali3.message_text import unit_text
from fmu_src.variables.arrays import Array, references
from fmu_src.variables.text_variables import TextVariable
from fmu_src.variables.variables import Variable
from mbs.results.comparison import Compared

_SOURCES = {
    "input": "SLAVE_INPUT",
    "parameter": "SLAVE_PARAMETER",
    "pose": "SLAVE_POSE",
    "step_size": "SLAVE_STEP_SIZE",
    "fidelity": "SLAVE_FIDELITY",
    "step_iterations": "SLAVE_STEP_ITERATIONS",
    "settling": "SLAVE_SETTLING",
    "lead": "SLAVE_LEAD",
    "sensor": "SLAVE_SENSOR",
    "solver": "SLAVE_SOLVER",
    "capped_residual": "SLAVE_CAPPED_RESIDUAL",
    "ahead": "SLAVE_AHEAD",
    "constant": "SLAVE_CONSTANT",
}
ROLL = "chassis.roll"
"""Output that is more than a quarter turn when a vehicle lies upside down."""
GROUND = "chassis.ground_force"
"""Output that is not 0 at the start of a vehicle that does not stand on its wheels alone."""


def c_table(
    table: Sequence[Variable],
    names: Mapping[str, Sequence[Sequence[str]]],
    identity: str,
    token: str,
    texts: Sequence[TextVariable] = (),
    followers: Sequence[int] = (-1,),
    judged: Mapping[int, Compared] | None = None,
    length: float = 1.0,
    generated: Sequence[str] = (),
) -> str:
    """`table.c` of the shell.

    Parameters
    ----------
    table : sequence of Variable
        Inputs, parameters, outputs, constants.
    names : mapping
        Names of the constraint rows (``"row"``), force elements (``"element"``) and of coordinates that tables are over
        (``"coordinate"``, up to the last of them, others empty) of each System, for messages; sentences that are told
        at a start (``"notice"``).
    identity : str
        32 hexadecimal digits.
    token : str
        GUID or instantiation token.
    followers : sequence of int
        Per System the number of the one that computes what it leaves out; -1: none.
    judged : mapping of int to Compared
        What two motions are compared by: sensors by their numbers.
    length : float
        Of the model, m.
    generated : sequence of str
        Per System the name of its generated code; empty: there is none.
    """
    units = [unit_text(v.unit) for v in table]
    uncomputed = [sum(1 << k for k in v.uncomputed) for v in table]
    variables = "\n".join(
        f"    {{{c_string(v.name)}, {c_string(unit)}, {_SOURCES[v.source]}, {v.index}, "
        f"{_number(v.start, '0.0')}, {_number(v.min, '-HUGE_VAL')}, {_number(v.max, 'HUGE_VAL')}, "
        f"{str(v.whole).lower()}, {str(v.variability == 'fixed').lower()}, {str(v.port).lower()}, {v.road}, {bits:#x}, "
        f"{_number((v.works or [None])[0], '-HUGE_VAL')}, {_number((v.works or [None])[-1], 'HUGE_VAL')}, "
        f"{v.role}, {v.other}, {_number(v.scale, '1.0')}, {{{', '.join(map(repr, v.figures)) or '0.0'}}}, "
        f"{_comparison_row(v, judged or {})}}},"
        for v, unit, bits in zip(table, units, uncomputed, strict=True)
    )
    code = ", ".join(f"0x{identity[i : i + 2]}" for i in range(0, 32, 2))
    count = sum(v.causality in ("input", "parameter") for v in table)
    roll, ground = (
        next((k for k, v in enumerate(table) if (v.ours or v.name) == name), len(table)) for name in (ROLL, GROUND)
    )
    return (
        "/* Generated with the FMU from its table of variables. */\n"
        '#include <math.h>\n\n#include "slave.h"\n\n'
        f"static const slave_variable variables[] = {{\n{variables}\n}};\n\n"
        f"{_texts(texts)}{_names('row', names['row'])}{_names('element', names['element'])}"
        f"{_names('coordinate', names['coordinate'])}{_names('notice', names['notice'])}"
        f"{_generated_code(generated, len(names['row']))}"
        f"static const int32_t follower[] = {{{', '.join(map(str, followers))}}};\n\n"
        f"const slave_table slave_the_table = {{\n    {c_string(token)},\n    {{{code}}},\n    variables, "
        f"{len(table)}, {count},\n    row, first_row, element, first_element, coordinate, first_coordinate, "
        f"notice, first_notice, {len(names['row'])}, follower, generated,\n"
        f"    texts, {len(texts)}, {roll}, {ground}, {_number(length, '1.0')},\n}};\n"
    )


def _comparison_row(variable: Variable, judged: Mapping[int, Compared]) -> str:
    """Unit, kind and factor by which a variable is compared, as C; -1: it is not."""
    comparison = judged.get(variable.index) if variable.source == "sensor" else None
    if comparison is None:
        return "{-1, 0, 0.0}"
    return f"{{{comparison.fields.unit:d}, {comparison.fields.kind}, {comparison.factor!r}}}"


def _texts(texts: Sequence[TextVariable]) -> str:
    lines = (
        "\n".join(f"    {{{c_string(t.name)}, {t.road}, {c_string(t.start)}}}," for t in texts)
        or "    {NULL, 0, NULL},"
    )
    return f"static const slave_text texts[] = {{\n{lines}\n}};\n\n"


def _generated_code(names: Sequence[str], systems: int) -> str:
    """Declarations of the generated code of each System, as C."""
    none = f"static const ali3_generated *const generated[{systems}] = {{NULL}};\n"
    if not names:
        return f"{none}\n"
    declared = "".join(f"extern const ali3_generated {name};\n" for name in dict.fromkeys(names))
    addresses = ", ".join(f"&{name}" for name in names)
    return (
        f'#include "generated.h"\n\n#ifdef ALI3_GENERATES\n{declared}'
        f"static const ali3_generated *const generated[] = {{{addresses}}};\n#else\n{none}#endif\n\n"
    )


def _names(what: str, of_systems: Sequence[Sequence[str]]) -> str:
    """Names of all Systems one after the other, and where each System begins."""
    lines = "\n".join(f"    {c_string(name)}," for one in of_systems for name in one) or "    NULL,"
    first = ", ".join(str(sum(map(len, of_systems[:k]))) for k in range(len(of_systems) + 1))
    return (
        f"static const char *const {what}[] = {{\n{lines}\n}};\n\nstatic const size_t first_{what}[] = {{{first}}};\n\n"
    )


def c_string(text: str) -> str:
    """A C string literal; bytes beyond ASCII as octal escapes."""
    return '"' + "".join(chr(b) if 32 <= b < 127 and b not in b'"\\?' else f"\\{b:03o}" for b in text.encode()) + '"'


def _number(value: float | None, otherwise: str) -> str:
    return otherwise if value is None else repr(float(value))


def c_arrays(groups: Sequence[Array]) -> str:
    """The part of `table.c` that FMI 3.0 adds."""
    items = [k for group in groups for k in group.items]
    numbers, time = references(groups)
    sizes = {time: 0} | {number: len(group.items) for number, group in zip(numbers, groups, strict=True)}
    first = [0, *accumulate(sizes[number] for number in sorted(sizes))]
    return (
        '\n#include "fmi3_adapter.h"\n\n'
        f"static const uint32_t items[] = {{{', '.join(map(str, items))}}};\n\n"
        f"static const size_t first[] = {{{', '.join(map(str, first))}}};\n\n"
        f"const fmi3_table fmi3_the_table = {{items, first, {len(sizes)}, {time}}};\n"
    )
