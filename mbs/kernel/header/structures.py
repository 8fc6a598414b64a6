"""Structures from the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from ctypes import POINTER, Structure, c_double, c_int32, c_int64, c_void_p


class SettingsFields(Structure):
    """`ali3_settings`."""

    _fields_ = (
        ("alpha", c_double),
        ("eps_rel", c_double),
        ("tolerance_r", c_double),
        ("tolerance_phi", c_double),
        ("rho_infinity", c_double),
        ("max_iterations", c_int32),
        ("max_halvings", c_int32),
        ("project", c_int32),
        ("update", c_int32),
        ("geometric", c_int32),
        ("method", c_int32),
        ("predictor", c_int32),
        ("step_iterations", c_int32),
        ("part_ratio", c_double),
    )


class ReportFields(Structure):
    """`ali3_report`."""

    _fields_ = (
        ("steps", c_int64),
        ("iterations", c_int64),
        ("factorizations", c_int64),
        ("solves", c_int64),
        ("halvings", c_int64),
        ("failures", c_int64),
        ("last_iterations", c_int32),
        ("max_iterations", c_int32),
        ("last_status", c_int32),
        ("negative_pivots", c_int32),
        ("residual", c_double),
        ("violation", c_double),
        ("velocity_violation", c_double),
        ("worst_row", c_int32),
        ("worst_coordinate", c_int32),
        ("energy_jump", c_double),
        ("energy_error", c_double),
        ("energy", c_double),
        ("work", c_double),
        ("kinetic_peak", c_double),
        ("speed_peak", c_double),
        ("velocity_path", c_double),
        ("predictor_path", c_double),
        ("velocity_squares", c_double),
        ("predictor_squares", c_double),
        ("fastest_rate", c_double),
        ("open_power", c_double),
        ("energy_floor", c_double),
        ("free_states", c_int64),
        ("free_start", c_double),
        ("free_steps", c_double),
        ("free_energy", c_double),
        ("free_steps_squares", c_double),
        ("free_energy_squares", c_double),
        ("free_product", c_double),
        ("rim_pressed", c_double),
        ("rim_time", c_double),
        ("rim_x", c_double),
        ("rim_y", c_double),
        ("rim_element", c_int64),
        ("largest_force", c_double),
        ("largest_load", c_double),
        ("abrupt_steps", c_int64),
        ("divisions", c_int64),
        ("change_rate", c_double),
        ("branch_changes", c_int64),
        ("branch_time", c_double),
        ("branch_kind", c_int32),
        ("branch_loop", c_int32),
        ("branch_triad", c_int32),
        ("balance", c_int32),
        ("capped", c_int64),
        ("capped_residual", c_double),
    )


class Sizes(Structure):
    """`ali3_sizes`."""

    _fields_ = (
        ("nq", c_int32),
        ("nc", c_int32),
        ("nu", c_int32),
        ("ng", c_int32),
        ("ne", c_int32),
        ("ny", c_int32),
        ("ns", c_int32),
        ("np", c_int32),
        ("nout", c_int32),
        ("nf", c_int32),
        ("front_size", c_int32),
        ("nnz_mass", c_int32),
        ("nnz_rows", c_int32),
        ("nsig", c_int32),
        ("has_pose", c_int32),
        ("n_switch", c_int32),
    )


class ControlFields(Structure):
    """`ali3_control`."""

    _fields_ = (
        ("tolerance", c_double),
        ("length", c_double),
        ("span", c_double),
        ("rate", c_double),
        ("longest", c_double),
        ("h", c_double),
        ("last", c_double),
        ("usual", c_double),
        ("smallest", c_double),
        ("largest", c_double),
        ("error_sum", c_double),
        ("forced_error", c_double),
        ("accepted", c_int64),
        ("rejected", c_int64),
        ("failed", c_int64),
        ("forced", c_int64),
        ("over_share", c_int64),
        ("side_steps", c_int64),
    )


class RecordFields(Structure):
    """`ali3_record`."""

    _fields_ = (
        ("n", c_int64),
        ("time", POINTER(c_double)),
        ("sensors", POINTER(c_double)),
        ("positions", POINTER(c_double)),
    )


class LaneFields(Structure):
    """`ali3_lane`."""

    _fields_ = (
        ("instance", c_void_p),
        ("inputs", POINTER(c_double)),
        ("out", POINTER(c_double)),
        ("positions", POINTER(c_double)),
        ("done", c_int64),
        ("alone", c_int64),
        ("status", c_int32),
    )


class JudgedFields(Structure):
    """`ali3_judged`."""

    _fields_ = (
        ("unit", c_int32),
        ("kind", c_int32),
        ("factor", c_double),
    )


class ComparedFields(Structure):
    """`ali3_compared`."""

    _fields_ = (
        ("least", c_double),
        ("most", c_double),
        ("last", c_double),
        ("turns", c_double),
        ("quickest", c_double),
        ("gap", c_double),
        ("time", c_double),
        ("latest", c_double),
        ("samples", c_int64),
        ("in_turn", c_int64),
    )


class InputTable(Structure):
    """`ali3_input_table`."""

    _fields_ = (
        ("input", c_int32),
        ("n", c_int64),
        ("time", POINTER(c_double)),
        ("value", POINTER(c_double)),
    )


class InputTables(Structure):
    """`ali3_input_tables`."""

    _fields_ = (
        ("tolerance", c_double),
        ("n", c_int32),
        ("table", POINTER(InputTable)),
    )


STRUCTURES = {
    "ali3_settings": SettingsFields,
    "ali3_report": ReportFields,
    "ali3_sizes": Sizes,
    "ali3_control": ControlFields,
    "ali3_record": RecordFields,
    "ali3_lane": LaneFields,
    "ali3_judged": JudgedFields,
    "ali3_compared": ComparedFields,
    "ali3_input_table": InputTable,
    "ali3_input_tables": InputTables,
}
"""Structures by their names in C."""
