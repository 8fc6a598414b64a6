"""FMI 2.0 and FMI 3.0: what each packs in its own way."""

from __future__ import annotations

from fmu_src.arrays import arrays
from fmu_src.description import Description, model_description
from fmu_src.description_fmi3 import build_description, model_description_fmi3, terminals
from fmu_src.native.package import Face, NativeContents
from fmu_src.native.table import c_arrays, c_table
from fmu_src.platforms import FMI3_FOLDERS, TARGETS


def _tables_fmi2(contents: NativeContents, identity: str, guid: str) -> str:
    return c_table(contents.table, contents.rows, identity, guid)


def _documents_fmi2(head: Description, contents: NativeContents) -> dict[str, bytes]:
    return {"modelDescription.xml": model_description(head, contents.table, contents.reach)}


FMI2 = Face(
    "fmi2",
    (
        "FMI 2.0 co-simulation in C: it needs nothing but the C library of its platform, and can be compiled from its "
        "folder sources (compilers other than the one used here may change the last bits unless they are kept from "
        "fusing multiplications and additions: -ffp-contract=off).",
        "Derivatives of inputs up to the third order are followed inside a communication step and forgotten after it. "
        "Outputs that are positions, angles or velocities have first time derivatives. Directional derivatives of "
        "outputs by inputs are those over the last inner step, the state before it held; in initialisation mode those "
        "of the initial state.",
    ),
    {platform: {platform: targets} for platform, targets in TARGETS.items()},
    "model.png",
    _tables_fmi2,
    _documents_fmi2,
)


def _tables_fmi3(contents: NativeContents, identity: str, token: str) -> str:
    return _tables_fmi2(contents, identity, token) + c_arrays(arrays(contents.table))


def _documents_fmi3(head: Description, contents: NativeContents) -> dict[str, bytes]:
    groups = arrays(contents.table)
    buses = terminals(groups)
    return {
        "modelDescription.xml": model_description_fmi3(head, contents.table, groups, contents.reach),
        "sources/buildDescription.xml": build_description(contents.model_name, head.sources),
    } | ({"terminalsAndIcons/terminalsAndIcons.xml": buses} if buses is not None else {})


FMI3 = Face(
    "fmi3",
    (
        "FMI 3.0 co-simulation in C: it needs nothing but the C library of its platform, and can be compiled from its "
        "folder sources. Components of a vector are one array variable, in the order its description says.",
        "Outputs that are positions, angles or velocities have first time derivatives. Directional and adjoint "
        "derivatives of outputs by inputs are those over the last inner step, the state before it held; in "
        "initialisation mode those of the initial state.",
    ),
    {platform: {FMI3_FOLDERS[target]: (target,) for target in targets} for platform, targets in TARGETS.items()},
    "terminalsAndIcons/icon.png",
    _tables_fmi3,
    _documents_fmi3,
)
