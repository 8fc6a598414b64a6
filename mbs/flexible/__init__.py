"""Flexible bodies: beam finite elements, Craig-Bampton reduction, shape integrals, stress recovery."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.flexible import scene_part as scene_part
    from mbs.flexible.calculix import read_calculix as read_calculix
    from mbs.flexible.component_modes import craig_bampton as craig_bampton
    from mbs.flexible.damping import RayleighDamping as RayleighDamping
    from mbs.flexible.fe_model import FiniteElementModel as FiniteElementModel
    from mbs.flexible.fixed_interface import Interface as Interface
    from mbs.flexible.frame import Beam as Beam
    from mbs.flexible.frame import Frame as Frame
    from mbs.flexible.frequencies import natural_modes as natural_modes
    from mbs.flexible.inertia_integrals import ShapeIntegrals as ShapeIntegrals
    from mbs.flexible.inertia_integrals import shape_integrals as shape_integrals
    from mbs.flexible.load_paths import interface_loads as interface_loads
    from mbs.flexible.load_paths import load_path_modes as load_path_modes
    from mbs.flexible.material import Material as Material
    from mbs.flexible.matrix_files import external_model as external_model
    from mbs.flexible.matrix_files import read_matrix as read_matrix
    from mbs.flexible.matrix_files import read_model as read_model
    from mbs.flexible.modal_body import InterfaceModes as InterfaceModes
    from mbs.flexible.mode_choice import ModeChoice as ModeChoice
    from mbs.flexible.mode_choice import modes_for_output as modes_for_output
    from mbs.flexible.nastran import read_nastran as read_nastran
    from mbs.flexible.recovery import StrainGauge as StrainGauge
    from mbs.flexible.recovery import gauge_rows as gauge_rows
    from mbs.flexible.recovery import section_forces as section_forces
    from mbs.flexible.recovery import stress_field as stress_field
    from mbs.flexible.reduced_body import ReducedBody as ReducedBody
    from mbs.flexible.relief_matrices import InertiaRelief as InertiaRelief
    from mbs.flexible.relief_solution import inertia_relief as inertia_relief
    from mbs.flexible.section import Section as Section
    from mbs.flexible.section import rectangle as rectangle
    from mbs.flexible.section import round_bar as round_bar
    from mbs.flexible.section import tube as tube

# imported at first use: a model of beams needs no reader of matrices
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
    "inertia_relief": "mbs.flexible.relief_solution",
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

__all__ = [*_LAZY]
