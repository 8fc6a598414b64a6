"""Numbers and structures of the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from ctypes import POINTER, Structure, c_double, c_int32, c_int64
from enum import IntEnum

OPEN = 1e-9
"""A row that is open by less, m, is not why something failed."""
FARTHEST = 1e8
"""Largest distance of a start, m."""
FASTEST = 1e6
"""Largest speed of a start, m/s."""
BALANCE_WRONG = 0.036
"""Energy balance above which, at any time, no run was right that was tried."""
HALVINGS_SUSPECT = 0.1
"""Halvings per step above which a run is suspect."""
SYSTEM_VERSION = 1
"""Of the System file."""
DOUBT_FROM = 100
"""Steps that a run makes before it is judged."""
ROAD_VERSION = 1
"""Of a road file."""
ROAD_SHARED = 2
"""Of a road file whose equal tiles are stored once."""
ROAD_TILE = 32
"""Points along the side of a tile of a road file."""
ROAD_HIGHEST = 1e5
"""Largest height of a road file, m."""
ROAD_FARTHEST = 1e8
"""Largest coordinate of a road file, m."""
ROAD_FRICTION = 10.0
"""Largest friction of a road file."""
ROAD_POINTS = 1e12
"""Most points of a road file."""

FLOAT_ARRAYS = (
    "q0",
    "qd0",
    "y0",
    "mass_val",
    "gravity_force",
    "gravity_const",
    "row_lin",
    "row_const",
    "row_scale",
    "row_measure",
    "quad_h",
    "angle_hc",
    "angle_hs",
    "gterm_h",
    "velocity_h",
    "sig_val",
    "sig_const",
    "el_real",
    "input_start",
    "input_min",
    "input_max",
    "guide_real",
    "road_real",
    "par_value",
    "par_min",
    "par_max",
    "par_scale",
    "pose_0",
    "pose_cos",
    "pose_sin",
    "pose_x",
    "pose_y",
    "pose_z",
    "pose_speed",
    "sen_real",
    "flex_gravity",
    "flex_P",
    "flex_c",
    "flex_T",
    "flex_K",
    "flex_C",
    "tree_base",
    "tree_mass",
    "tree_centre",
    "tree_inertia",
    "tree_gravity",
    "tree_out_local",
    "tree_cut_place",
    "tree_angle_sign",
    "tree_angle_inertia",
    "static_value",
    "static_q",
    "par_offset",
    "payload_mass",
    "payload_gravity",
    "tree_payload_place",
    "ported_val",
    "ported_const",
)
"""Arrays of a System of type double."""

INTEGER_ARRAYS = (
    "mass_ptr",
    "mass_col",
    "mass_pos",
    "row_ptr",
    "row_col",
    "row_front",
    "row_loc",
    "quad_ptr",
    "quad_a",
    "quad_b",
    "angle_row",
    "angle_theta",
    "angle_ptr",
    "angle_a",
    "angle_b",
    "gterm_row",
    "gterm_guide",
    "gterm_power",
    "gterm_a",
    "gterm_b",
    "row_switch",
    "switch_start",
    "velocity_row",
    "velocity_ptr",
    "velocity_a",
    "velocity_b",
    "front_col",
    "front_ptr",
    "front_idx",
    "front_parent",
    "front_map",
    "front_off",
    "sig_ptr",
    "sig_col",
    "el_type",
    "el_sig_ptr",
    "el_sig",
    "el_real_ptr",
    "el_int_ptr",
    "el_int",
    "el_state_ptr",
    "el_out_ptr",
    "el_front",
    "el_loc_ptr",
    "el_loc",
    "guide_type",
    "guide_input",
    "guide_real_ptr",
    "road_type",
    "road_real_ptr",
    "par_ptr",
    "par_target",
    "par_index",
    "sen_type",
    "sen_int_ptr",
    "sen_int",
    "sen_real_ptr",
    "flex_mode_ptr",
    "flex_frame",
    "flex_mode",
    "flex_front",
    "flex_loc",
    "tree_parent",
    "tree_slides",
    "tree_frame",
    "tree_out_body",
    "tree_out_col",
    "tree_cut_body",
    "tree_cut_rows",
    "tree_angle_col",
    "tree_angle_ptr",
    "tree_angle_joint",
    "mode_triad_ptr",
    "mode_triad",
    "mode_cell_ptr",
    "mode_cell",
    "mode_name_ptr",
    "mode_name",
    "static_start",
    "static_par",
    "pose_partner",
    "par_fixed",
    "payload_signal",
    "tree_payload_body",
    "guide_second",
    "ported_ptr",
    "ported_row",
)
"""Arrays of a System of type int32_t."""

OPTIONAL_ARRAYS = (
    "mode_triad_ptr",
    "mode_triad",
    "mode_cell_ptr",
    "mode_cell",
    "mode_name_ptr",
    "mode_name",
    "static_start",
    "static_par",
    "static_value",
    "static_q",
    "pose_partner",
    "par_offset",
    "par_fixed",
    "payload_mass",
    "payload_signal",
    "payload_gravity",
    "tree_payload_body",
    "tree_payload_place",
    "guide_second",
    "ported_ptr",
    "ported_row",
    "ported_val",
    "ported_const",
)
"""Those that a System need not have."""


class Status(IntEnum):
    """Codes of `ali3_status`: how a call of the kernel ended."""

    OK = 0
    BAD_ARGUMENT = 1
    BAD_FILE = 2
    BAD_STATE = 3
    NO_MEMORY = 4
    NOT_INITIALISED = 5
    NOT_ASSEMBLED = 6
    NOT_CONVERGED = 7
    SINGULAR = 8
    NOT_FINITE = 9
    WRONG_METHOD = 10
    START_REFUSED = 11
    UNRESOLVED = 12
    NO_TREE = 13
    TOO_STIFF = 14
    TOO_FAR = 15
    NO_EQUILIBRIUM = 16
    BRANCH_CHANGED = 17
    FIXED_PARAMETER = 18
    BAD_ROAD = 19
    ROAD_LOST = 20
    TOO_DEAR = 21
    WHEEL_IN_ROAD = 22


class Update(IntEnum):
    """`ali3_settings.update`."""

    LINEARISED = 0
    PAPER = 1


class Predictor(IntEnum):
    """`ali3_settings.predictor`."""

    PARABOLA = 0
    ACCELERATION = 1


class BranchKind(IntEnum):
    """`ali3_report.branch_kind`."""

    NONE = 0
    LEFT = 1
    JUMP = 2


class SolverValue(IntEnum):
    """What the solver says about itself."""

    ITERATIONS = 0
    VIOLATION = 1
    RESIDUAL = 2
    FACTORIZATIONS = 3
    HALVINGS = 4
    STATUS = 5
    ENERGY_ERROR = 6
    ENERGY_BALANCE = 7
    CAPPED = 8


class ParameterTarget(IntEnum):
    """What a parameter writes to."""

    ELEMENT = 0
    GUIDE = 1
    ROAD = 2
    PAYLOAD = 3
    SWITCH = 4


class GuideType(IntEnum):
    """Types of guides."""

    OF_TIME = 0
    OF_INPUT = 1
    OF_TWO_INPUTS = 2


class RoadType(IntEnum):
    """Types of roads."""

    PLANE = 0
    KERB = 1
    GRID = 2


class SensorReads(IntEnum):
    """What the value of a sensor comes from."""

    MOTION = 0
    INPUTS = 1
    FORCES = 2
    SOLVER = 3
    ROWS = 4


class Doubt(IntEnum):
    """`ali3_doubt`: what a run says against itself."""

    NONE = 0
    HALVINGS = 1
    BALANCE = 2


class MethodNumber(IntEnum):
    """`ali3_settings.method`."""

    ALI3P = 0
    GENERALISED_ALPHA = 1
    ENERGY_MOMENTUM = 2
    ENERGY_MOMENTUM_4 = 3
    RUNGE_KUTTA_8 = 4
    SEMI_RECURSIVE = 5
    SEMI_RECURSIVE_4 = 6
    RADAU_5 = 7


METHOD_ORDERS = {
    MethodNumber.ALI3P: 2,
    MethodNumber.GENERALISED_ALPHA: 1,
    MethodNumber.ENERGY_MOMENTUM: 2,
    MethodNumber.ENERGY_MOMENTUM_4: 3,
    MethodNumber.RUNGE_KUTTA_8: 8,
    MethodNumber.SEMI_RECURSIVE: 8,
    MethodNumber.SEMI_RECURSIVE_4: 4,
    MethodNumber.RADAU_5: 5,
}
"""Orders of steps that change."""


class SensorType(IntEnum):
    """Types of sensors."""

    SIGNAL = 0
    SIGNAL_RATE = 1
    SIGNAL_SECOND_RATE = 2
    COMPONENT = 3
    ANGLE = 4
    PITCH = 5
    ANGULAR_RATE = 6
    QUATERNION = 7
    ELEMENT_OUTPUT = 8
    REACTION = 9
    ENERGY = 10
    INPUT = 11
    GUIDE = 12
    SOLVER = 13
    NORM = 14
    DIRECTION = 15
    ANGLE_ABOUT = 16
    QUASI_STATIC = 17
    REACTION_PRODUCTS = 18
    WORK = 19
    MASS = 20
    GUIDE_EXCESS = 21


SENSOR_READS = {
    SensorType.SIGNAL: SensorReads.MOTION,
    SensorType.SIGNAL_RATE: SensorReads.MOTION,
    SensorType.SIGNAL_SECOND_RATE: SensorReads.FORCES,
    SensorType.COMPONENT: SensorReads.MOTION,
    SensorType.ANGLE: SensorReads.MOTION,
    SensorType.PITCH: SensorReads.MOTION,
    SensorType.ANGULAR_RATE: SensorReads.MOTION,
    SensorType.QUATERNION: SensorReads.MOTION,
    SensorType.ELEMENT_OUTPUT: SensorReads.FORCES,
    SensorType.REACTION: SensorReads.ROWS,
    SensorType.ENERGY: SensorReads.FORCES,
    SensorType.INPUT: SensorReads.INPUTS,
    SensorType.GUIDE: SensorReads.INPUTS,
    SensorType.SOLVER: SensorReads.SOLVER,
    SensorType.NORM: SensorReads.MOTION,
    SensorType.DIRECTION: SensorReads.MOTION,
    SensorType.ANGLE_ABOUT: SensorReads.MOTION,
    SensorType.QUASI_STATIC: SensorReads.ROWS,
    SensorType.REACTION_PRODUCTS: SensorReads.ROWS,
    SensorType.WORK: SensorReads.FORCES,
    SensorType.MASS: SensorReads.MOTION,
    SensorType.GUIDE_EXCESS: SensorReads.INPUTS,
}


class ElementType(IntEnum):
    """Types of force elements."""

    SPRING_DAMPER = 1
    SCALAR_SPRING_DAMPER = 2
    INPUT_FORCE = 3
    BODY_FORCE = 4
    BODY_TORQUE = 5
    GYROSCOPIC_SPIN = 6
    DRAG = 7
    TYRE = 8
    BRAKE = 9
    AUTOMATIC_DRIVE = 10
    CONTACT_POINTS = 11
    SPIN_TORQUE = 12
    ELECTRIC_DRIVE = 13
    SPRING_DAMPER_TABLE = 14
    LIFT = 15
    COORDINATE_FRICTION = 16
    TORSION_BAR = 17
    SPIN_ANGLE = 18


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
        ("fastest_rate", c_double),
        ("open_power", c_double),
        ("branch_changes", c_int64),
        ("branch_time", c_double),
        ("branch_kind", c_int32),
        ("branch_loop", c_int32),
        ("branch_triad", c_int32),
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
    "ali3_input_table": InputTable,
    "ali3_input_tables": InputTables,
}
"""By their names in C."""
