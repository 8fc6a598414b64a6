"""The shared library of the kernel: its path, the signatures of its functions, the check of its version."""

import ctypes
import os
import sys
from ctypes import POINTER, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from pathlib import Path
from typing import Any

from ..header.structures import (
    STRUCTURES,
    ComparedFields,
    ControlFields,
    JudgedFields,
    LaneFields,
    RecordFields,
    ReportFields,
    SettingsFields,
    Sizes,
)
from .buffers import DOUBLES

_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "ali3_status_text": (c_char_p, [c_int32]),
    "ali3_status_remedy": (c_char_p, [c_int32]),
    "ali3_status_cause": (c_int32, [c_int32]),
    "ali3_version": (c_uint32, []),
    "ali3_structure_size": (c_size_t, [c_char_p]),
    "ali3_system_load": (c_int32, [c_char_p, c_size_t, POINTER(c_void_p), c_char_p, c_size_t]),
    "ali3_system_free": (None, [c_void_p]),
    "ali3_system_sizes": (Sizes, [c_void_p]),
    "ali3_system_structure": (c_uint32, [c_void_p]),
    "ali3_system_attach": (c_int32, [c_void_p, c_void_p, c_char_p, c_size_t]),
    "ali3_instance_size": (c_size_t, [c_void_p]),
    "ali3_instance_new": (c_int32, [c_void_p, POINTER(c_void_p)]),
    "ali3_instance_free": (None, [c_void_p]),
    "ali3_set_road": (c_int32, [c_void_p, c_int32, c_char_p, c_char_p, c_size_t]),
    "ali3_road_lost": (c_char_p, [c_void_p]),
    "ali3_grid_heights": (None, [c_int32, c_int32, DOUBLES, DOUBLES, c_int64, DOUBLES, DOUBLES]),
    "ali3_beyond_table": (c_int32, [c_void_p, POINTER(c_int32), DOUBLES]),
    "ali3_wheel_in_road": (c_int32, [c_void_p, POINTER(c_int32), c_char_p, c_size_t]),
    "ali3_reset": (c_int32, [c_void_p]),
    "ali3_default_settings": (SettingsFields, []),
    "ali3_set_settings": (c_int32, [c_void_p, POINTER(SettingsFields)]),
    "ali3_get_settings": (c_int32, [c_void_p, POINTER(SettingsFields)]),
    "ali3_set_input": (c_int32, [c_void_p, c_int32, c_double]),
    "ali3_get_input": (c_int32, [c_void_p, c_int32, DOUBLES]),
    "ali3_set_input_function": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "ali3_set_input_breaks": (c_int32, [c_void_p, DOUBLES, c_int64]),
    "ali3_set_parameter": (c_int32, [c_void_p, c_int32, c_double]),
    "ali3_try_parameter": (c_int32, [c_void_p, c_int32, c_double]),
    "ali3_get_parameter": (c_int32, [c_void_p, c_int32, DOUBLES]),
    "ali3_set_pose": (c_int32, [c_void_p, DOUBLES]),
    "ali3_set_q": (c_int32, [c_void_p, DOUBLES, DOUBLES]),
    "ali3_set_switch": (c_int32, [c_void_p, c_int32, c_int32]),
    "ali3_get_switch": (c_int32, [c_void_p, c_int32, POINTER(c_int32)]),
    "ali3_initialise": (c_int32, [c_void_p, c_double]),
    "ali3_settle": (c_int32, [c_void_p, c_double, c_double]),
    "ali3_start_text": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "ali3_unsettled": (c_double, [c_void_p]),
    "ali3_start_excess": (c_double, [c_void_p, POINTER(c_int32), POINTER(c_char_p)]),
    "ali3_method_excludes": (c_char_p, [c_void_p]),
    "ali3_static_equilibrium": (c_int32, [c_void_p, c_double, c_double, c_int32]),
    "ali3_step": (c_int32, [c_void_p, c_double]),
    "ali3_run": (c_int32, [c_void_p, c_double, c_int64, DOUBLES, c_int64, DOUBLES, DOUBLES, POINTER(c_int64)]),
    "ali3_widest_lanes": (c_int32, []),
    "ali3_many_size": (c_size_t, [c_void_p, c_int32]),
    "ali3_many_new": (c_int32, [c_void_p, c_int32, POINTER(c_void_p)]),
    "ali3_many_free": (None, [c_void_p]),
    "ali3_many_run": (c_int32, [c_void_p, c_int32, POINTER(LaneFields), c_double, c_int64, c_int64]),
    "ali3_control_run": (
        c_int32,
        [
            c_void_p,
            POINTER(ControlFields),
            DOUBLES,
            c_double,
            c_int64,
            POINTER(RecordFields),
            POINTER(c_int64),
        ],
    ),
    "ali3_refresh": (c_int32, [c_void_p]),
    "ali3_sensors": (c_int32, [c_void_p, DOUBLES]),
    "ali3_ports_follow": (c_int32, [c_void_p, c_void_p]),
    "ali3_sensor_rates": (c_int32, [c_void_p, DOUBLES, c_char_p]),
    "ali3_report_get": (c_int32, [c_void_p, POINTER(ReportFields)]),
    "ali3_energy_balance": (c_double, [POINTER(ReportFields)]),
    "ali3_rim_text": (c_int32, [c_void_p, POINTER(c_int32), c_char_p, c_size_t]),
    "ali3_branch_text": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "ali3_time": (c_double, [c_void_p]),
    "ali3_solver_value": (c_double, [c_void_p, c_int32]),
    "ali3_capped_residual": (c_double, [c_void_p]),
    "ali3_compare": (
        None,
        [POINTER(JudgedFields), c_int32, c_int64, DOUBLES, DOUBLES, DOUBLES, POINTER(ComparedFields)],
    ),
    "ali3_compared_sizes": (
        None,
        [POINTER(JudgedFields), c_int32, POINTER(ComparedFields), c_double, c_double, c_int32, DOUBLES],
    ),
    "ali3_state_size": (c_size_t, [c_void_p]),
    "ali3_snapshot_size": (c_size_t, [c_void_p]),
    "ali3_snapshot_take": (None, [c_void_p, c_void_p]),
    "ali3_snapshot_restore": (None, [c_void_p, c_void_p]),
    "ali3_state_save": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "ali3_state_restore": (c_int32, [c_void_p, c_char_p, c_size_t]),
    "ali3_get_state": (c_int32, [c_void_p] + [DOUBLES] * 5),
    "ali3_evaluate": (c_int32, [c_void_p] + [DOUBLES] * 3 + [c_double] + [DOUBLES] * 6),
    "ali3_mass_matrix": (c_int32, [c_void_p, DOUBLES, DOUBLES]),
    "ali3_tangent": (c_int32, [c_void_p, c_double, DOUBLES, DOUBLES]),
    "ali3_element_step": (c_int32, [c_void_p] + [DOUBLES] * 3 + [c_double] + [DOUBLES] * 2),
}

_OTHER_SOURCES = ": it was compiled from other sources. Compile it again: python -m ali3 build --kernel"

_libraries: dict[str, ctypes.CDLL] = {}


def library_path() -> Path:
    """Path of the library: the environment variable ALI3_KERNEL_LIBRARY, otherwise in `lib/` of this package."""
    override = os.environ.get("ALI3_KERNEL_LIBRARY")
    if override:
        return Path(override)
    name = {"win32": "ali3.dll", "darwin": "libali3.dylib"}.get(sys.platform, "libali3.so")
    return Path(__file__).resolve().parents[1] / "lib" / name


def load_library(path: str | os.PathLike[str] | None = None) -> ctypes.CDLL:
    """Load the kernel and set the types of arguments and results; `path`: the library, by default `library_path()`.

    Raises `OSError` if there is no such library, or if it is for another platform or other sources than this package.
    """
    key = str(Path(path) if path is not None else library_path())
    if key in _libraries:
        return _libraries[key]
    if Path(key).name != key and not Path(key).is_file():  # the system searches for a bare name
        raise OSError(f"There is no kernel {key}. Compile it: python -m ali3 build --kernel")
    library = ctypes.CDLL(key)
    for name, (result, arguments) in _SIGNATURES.items():
        function = getattr(library, f"entry_{name}", None)  # with the floating-point control of the kernel
        if function is None:
            raise OSError(f"The kernel {key} has no function {name}{_OTHER_SOURCES}")
        function.restype = result
        function.argtypes = arguments
        setattr(library, name, function)
    for name, structure in STRUCTURES.items():
        size = ctypes.sizeof(structure)
        kernel_size = library.ali3_structure_size(name.encode())
        if kernel_size != size:
            raise OSError(f"In the kernel {key} {name} has {kernel_size} bytes, in this package {size}{_OTHER_SOURCES}")
    _libraries[key] = library
    return library
