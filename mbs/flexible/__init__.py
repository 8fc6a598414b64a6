"""Flexible bodies: beam finite elements, Craig-Bampton reduction, shape integrals, stress recovery."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.flexible import scene_part as scene_part
    from mbs.flexible.attachment_modes import inertia_relief
    from mbs.flexible.calculix import read_calculix
    from mbs.flexible.component_modes import craig_bampton
    from mbs.flexible.damping import RayleighDamping
    from mbs.flexible.fe_model import FiniteElementModel
    from mbs.flexible.fixed_interface import Interface
    from mbs.flexible.frame import Beam, Frame
    from mbs.flexible.frequencies import natural_modes
    from mbs.flexible.inertia_integrals import ShapeIntegrals, shape_integrals
    from mbs.flexible.load_paths import interface_loads, load_path_modes
    from mbs.flexible.material import Material
    from mbs.flexible.matrix_files import external_model, read_matrix, read_model
    from mbs.flexible.modal_body import InterfaceModes
    from mbs.flexible.mode_choice import ModeChoice, modes_for_output
    from mbs.flexible.nastran import read_nastran
    from mbs.flexible.recovery import StrainGauge, gauge_rows, section_forces, stress_field
    from mbs.flexible.reduced_body import ReducedBody
    from mbs.flexible.relief_matrices import InertiaRelief
    from mbs.flexible.section import Section, rectangle, round_bar, tube

# imported when they are first asked for: who reads a model of beams needs no reader of matrices
_LAZY = {
    "Beam": "mbs.flexible.frame",
    "FiniteElementModel": "mbs.flexible.fe_model",
    "Frame": "mbs.flexible.frame",
    "InertiaRelief": "mbs.flexible.relief_matrices",
    "Interface": "mbs.flexible.fixed_interface",
    "InterfaceModes": "mbs.flexible.modal_body",
    "Material": "mbs.flexible.material",
    "ModeChoice": "mbs.flexible.mode_choice",
    "RayleighDamping": "mbs.flexible.damping",
    "ReducedBody": "mbs.flexible.reduced_body",
    "Section": "mbs.flexible.section",
    "ShapeIntegrals": "mbs.flexible.inertia_integrals",
    "StrainGauge": "mbs.flexible.recovery",
    "craig_bampton": "mbs.flexible.component_modes",
    "external_model": "mbs.flexible.matrix_files",
    "gauge_rows": "mbs.flexible.recovery",
    "inertia_relief": "mbs.flexible.attachment_modes",
    "interface_loads": "mbs.flexible.load_paths",
    "load_path_modes": "mbs.flexible.load_paths",
    "modes_for_output": "mbs.flexible.mode_choice",
    "natural_modes": "mbs.flexible.frequencies",
    "read_calculix": "mbs.flexible.calculix",
    "read_matrix": "mbs.flexible.matrix_files",
    "read_model": "mbs.flexible.matrix_files",
    "read_nastran": "mbs.flexible.nastran",
    "rectangle": "mbs.flexible.section",
    "round_bar": "mbs.flexible.section",
    "section_forces": "mbs.flexible.recovery",
    "shape_integrals": "mbs.flexible.inertia_integrals",
    "stress_field": "mbs.flexible.recovery",
    "tube": "mbs.flexible.section",
}
__getattr__ = lazy_modules(__name__, ("scene_part",), _LAZY)

__all__ = [
    "Beam",
    "FiniteElementModel",
    "Frame",
    "InertiaRelief",
    "Interface",
    "InterfaceModes",
    "Material",
    "ModeChoice",
    "RayleighDamping",
    "ReducedBody",
    "Section",
    "ShapeIntegrals",
    "StrainGauge",
    "craig_bampton",
    "external_model",
    "gauge_rows",
    "inertia_relief",
    "interface_loads",
    "load_path_modes",
    "modes_for_output",
    "natural_modes",
    "read_calculix",
    "read_matrix",
    "read_model",
    "read_nastran",
    "rectangle",
    "round_bar",
    "section_forces",
    "shape_integrals",
    "stress_field",
    "tube",
]
