"""Differences between the archives of FMI 2.0 and FMI 3.0."""

from collections.abc import Callable, Sequence

from fmu_src.description.description import Description, model_description
from fmu_src.description.fmi3 import build_description, element_names, model_description_fmi3
from fmu_src.description.terminals import map_manifest, terminals
from fmu_src.native.package import Face, NativeContents
from fmu_src.native.platforms import FMI3_FOLDERS, PLATFORMS, TARGETS
from fmu_src.native.table import c_arrays
from fmu_src.variables.arrays import Array, arrays, scalars
from fmu_src.variables.variables import Variable


def _tables_fmi2(contents: NativeContents, identity: str, guid: str) -> str:
    return contents.table_c(identity, guid)


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
        "outputs by inputs are those over the last communication step, the state before it held; in initialisation "
        "mode those of the initial state.",
    ),
    {platform: {platform: targets} for platform, targets in TARGETS.items()},
    "model.png",
    _tables_fmi2,
    _documents_fmi2,
)


def _face_fmi3(group: Callable[[Sequence[Variable]], tuple[Array, ...]], words: str) -> Face:
    def tables(contents: NativeContents, identity: str, token: str) -> str:
        return _tables_fmi2(contents, identity, token) + c_arrays(group(contents.table))

    def documents(head: Description, contents: NativeContents) -> dict[str, bytes]:
        groups = group(contents.table)
        return (
            {
                "modelDescription.xml": model_description_fmi3(head, contents.table, groups, contents.reach),
                "sources/buildDescription.xml": build_description(contents.model_name, head.sources),
                "terminalsAndIcons/terminalsAndIcons.xml": terminals(groups),
            }
            | element_names(contents.table, groups)
            | map_manifest(groups)
        )

    return Face(
        "fmi3",
        (
            "FMI 3.0 co-simulation in C: it needs nothing but the C library of its platform, and can be compiled from "
            f"its folder sources. {words}",
            "Outputs that are positions, angles or velocities have first time derivatives. Directional and adjoint "
            "derivatives of outputs by inputs are those over the last communication step, the state before it held; "
            "in initialisation mode those of the initial state.",
        ),
        {name: {FMI3_FOLDERS[target]: (target,) for target in TARGETS[name]} for name in PLATFORMS},
        "terminalsAndIcons/icon.png",
        tables,
        documents,
    )


FMI3 = _face_fmi3(
    arrays,
    "Components of a vector are one array variable, in the order its description says. Some hosts read arrays as zeros "
    "without a message: give them the kind fmi3_scalar.",
)

FMI3_SCALAR = _face_fmi3(scalars, "Every variable is a scalar, for hosts that do not read arrays.")
