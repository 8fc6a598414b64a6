"""Numbers and structures of the kernel's C headers. Written by `python mbs/kernel/read_headers.py`."""

from ctypes import POINTER, Structure, c_double, c_int32, c_int64, c_void_p
from enum import IntEnum

OPEN = 1e-9
"""A row that is open by less, m, is not why something failed."""
FARTHEST = 1e8
"""Largest distance of a start, m."""
FASTEST = 1e6
"""Largest speed of a start, m/s."""
POSE = 7
"""Numbers of a pose."""
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
    "armature_inertia",
    "armature_ratio",
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
    "armature_col",
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
    "armature_col",
    "armature_inertia",
    "armature_ratio",
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
    ARMATURE = 5


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
    MAGIC_TYRE = 19


MAGIC_COEFFICIENTS = {
    "LFZO": 1.0,
    "LCX": 1.0,
    "LMUX": 1.0,
    "LEX": 1.0,
    "LKX": 1.0,
    "LHX": 1.0,
    "LVX": 1.0,
    "LGAX": 1.0,
    "LCY": 1.0,
    "LMUY": 1.0,
    "LEY": 1.0,
    "LKY": 1.0,
    "LHY": 1.0,
    "LVY": 1.0,
    "LGAY": 1.0,
    "LKYC": 1.0,
    "LKZC": 1.0,
    "LTR": 1.0,
    "LRES": 1.0,
    "LGAZ": 1.0,
    "LXAL": 1.0,
    "LYKA": 1.0,
    "LVYKA": 1.0,
    "LS": 1.0,
    "LSGKP": 1.0,
    "LSGAL": 1.0,
    "LMX": 1.0,
    "LVMX": 1.0,
    "LMY": 1.0,
    "LMUV": 0.0,
    "LONGVL": 16.7,
    "NOMPRES": 0.0,
    "Q_RE0": 1.0,
    "Q_V1": 0.0,
    "Q_V2": 0.0,
    "PFZ1": 0.0,
    "BREFF": 0.0,
    "DREFF": 0.0,
    "FREFF": 0.0,
    "LONGITUDINAL_STIFFNESS": 0.0,
    "LATERAL_STIFFNESS": 0.0,
    "PCFX1": 0.0,
    "PCFX2": 0.0,
    "PCFX3": 0.0,
    "PCFY1": 0.0,
    "PCFY2": 0.0,
    "PCFY3": 0.0,
    "PTX1": 0.0,
    "PTX2": 0.0,
    "PTX3": 0.0,
    "PTY1": 0.0,
    "PTY2": 1.0,
    "PCX1": 0.0,
    "PDX1": 0.0,
    "PDX2": 0.0,
    "PDX3": 0.0,
    "PEX1": 0.0,
    "PEX2": 0.0,
    "PEX3": 0.0,
    "PEX4": 0.0,
    "PKX1": 0.0,
    "PKX2": 0.0,
    "PKX3": 0.0,
    "PHX1": 0.0,
    "PHX2": 0.0,
    "PVX1": 0.0,
    "PVX2": 0.0,
    "PPX1": 0.0,
    "PPX2": 0.0,
    "PPX3": 0.0,
    "PPX4": 0.0,
    "RBX1": 0.0,
    "RBX2": 0.0,
    "RBX3": 0.0,
    "RCX1": 0.0,
    "REX1": 0.0,
    "REX2": 0.0,
    "RHX1": 0.0,
    "PCY1": 0.0,
    "PDY1": 0.0,
    "PDY2": 0.0,
    "PDY3": 0.0,
    "PEY1": 0.0,
    "PEY2": 0.0,
    "PEY3": 0.0,
    "PEY4": 0.0,
    "PEY5": 0.0,
    "PKY1": 0.0,
    "PKY2": 0.0,
    "PKY3": 0.0,
    "PKY4": 2.0,
    "PKY5": 0.0,
    "PKY6": 0.0,
    "PKY7": 0.0,
    "PHY1": 0.0,
    "PHY2": 0.0,
    "PHY3": 0.0,
    "PVY1": 0.0,
    "PVY2": 0.0,
    "PVY3": 0.0,
    "PVY4": 0.0,
    "PPY1": 0.0,
    "PPY2": 0.0,
    "PPY3": 0.0,
    "PPY4": 0.0,
    "PPY5": 0.0,
    "RBY1": 0.0,
    "RBY2": 0.0,
    "RBY3": 0.0,
    "RBY4": 0.0,
    "RCY1": 0.0,
    "REY1": 0.0,
    "REY2": 0.0,
    "RHY1": 0.0,
    "RHY2": 0.0,
    "RVY1": 0.0,
    "RVY2": 0.0,
    "RVY3": 0.0,
    "RVY4": 0.0,
    "RVY5": 0.0,
    "RVY6": 0.0,
    "QBZ1": 0.0,
    "QBZ2": 0.0,
    "QBZ3": 0.0,
    "QBZ4": 0.0,
    "QBZ5": 0.0,
    "QBZ6": 0.0,
    "QBZ9": 0.0,
    "QBZ10": 0.0,
    "QCZ1": 0.0,
    "QDZ1": 0.0,
    "QDZ2": 0.0,
    "QDZ3": 0.0,
    "QDZ4": 0.0,
    "QDZ6": 0.0,
    "QDZ7": 0.0,
    "QDZ8": 0.0,
    "QDZ9": 0.0,
    "QDZ10": 0.0,
    "QDZ11": 0.0,
    "QEZ1": 0.0,
    "QEZ2": 0.0,
    "QEZ3": 0.0,
    "QEZ4": 0.0,
    "QEZ5": 0.0,
    "QHZ1": 0.0,
    "QHZ2": 0.0,
    "QHZ3": 0.0,
    "QHZ4": 0.0,
    "PPZ1": 0.0,
    "PPZ2": 0.0,
    "SSZ1": 0.0,
    "SSZ2": 0.0,
    "SSZ3": 0.0,
    "SSZ4": 0.0,
    "QSX1": 0.0,
    "QSX2": 0.0,
    "QSX3": 0.0,
    "QSX4": 0.0,
    "QSX5": 0.0,
    "QSX6": 0.0,
    "QSX7": 0.0,
    "QSX8": 0.0,
    "QSX9": 0.0,
    "QSX10": 0.0,
    "QSX11": 0.0,
    "QSX12": 0.0,
    "QSX13": 0.0,
    "QSX14": 0.0,
    "PPMX1": 0.0,
    "QSY1": 0.0,
    "QSY2": 0.0,
    "QSY3": 0.0,
    "QSY4": 0.0,
    "QSY5": 0.0,
    "QSY6": 0.0,
    "QSY7": 0.0,
    "QSY8": 0.0,
}
"""Coefficients of the Magic Formula in the order of the element, with what holds where a file has none."""


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
        ("energy_floor", c_double),
        ("rim_pressed", c_double),
        ("rim_time", c_double),
        ("rim_x", c_double),
        ("rim_y", c_double),
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
    "ali3_input_table": InputTable,
    "ali3_input_tables": InputTables,
}
"""By their names in C."""
