"""Andrews' squeezing mechanism (IFToMM benchmark A03): seven planar bodies, a motor torque, a spring, no gravity.

Data and start angles: W. Schiehlen, Multibody System Dynamics 1, 1997; E. Hairer, G. Wanner, Solving ODEs II.
"""

from math import cos, sin

from mbs.model.model import Model

TORQUE = 0.033  # N m, of the motor on K1
STIFFNESS, FREE_LENGTH = 4530.0, 0.07785  # N/m, m
A, B, C, O = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072), (0.0, 0.0)  # m
BETA, THETA, GAMMA = -0.0617138900142764496, 0.0, 0.455279819163070380  # rad
PHI, DELTA = 0.222668390165885885, 0.487364979543842550
OMEGA, EPSILON = -0.222668390165885885, 1.23054744454982120
BODIES = {  # mass kg, inertia about the centre of mass kg m2
    "OF": (0.04325, 2.194e-6),
    "EF": (0.00365, 4.410e-7),
    "BDE": (0.02373, 5.255e-6),
    "EG": (0.00706, 5.667e-7),
    "AG": (0.07050, 1.169e-5),
    "EH": (0.00706, 5.667e-7),
    "AH": (0.05498, 1.912e-5),
}


def build() -> Model:
    """Model of the squeezer at rest in the published starting position."""
    m = Model("squeezer", dimension=2, gravity=(0.0, 0.0))
    points = {
        "F": _point_in_axes(O, BETA, 0.007, 0.0),
        "D": _point_in_axes(B, GAMMA, 0.020, -0.018),
        "E": _point_in_axes(B, GAMMA, 0.0, -0.035),
        "G": _point_in_axes(A, DELTA, 0.040, 0.0),
        "H": _point_in_axes(A, EPSILON, 0.0, -0.040),
    }
    centres = {
        "OF": _point_in_axes(O, BETA, 0.00092, 0.0),
        "EF": _point_in_axes(points["F"], BETA + THETA, -0.0115, 0.0),
        "BDE": _point_in_axes(B, GAMMA, 0.01043, -0.01874),
        "EG": _point_in_axes(points["G"], PHI + DELTA, 0.0, -(0.020 - 0.01421)),
        "AG": _point_in_axes(A, DELTA, 0.02308, 0.00916),
        "EH": _point_in_axes(points["H"], OMEGA + EPSILON, 0.020 - 0.01421, 0.0),
        "AH": _point_in_axes(A, EPSILON, -0.00449, -0.01228),
    }
    body = {name: m.body(name, mass=data[0], com=centres[name], inertia=data[1]) for name, data in BODIES.items()}
    m.revolute("O", m.ground, body["OF"], point=O)
    m.revolute("F", body["OF"], body["EF"], point=points["F"])
    m.revolute("B", m.ground, body["BDE"], point=B)
    m.revolute("E left", body["BDE"], body["EF"], point=points["E"])
    m.revolute("E upper", body["BDE"], body["EG"], point=points["E"])
    m.revolute("E lower", body["BDE"], body["EH"], point=points["E"])
    m.revolute("G", body["EG"], body["AG"], point=points["G"])
    m.revolute("A upper", m.ground, body["AG"], point=A)
    m.revolute("H", body["EH"], body["AH"], point=points["H"])
    m.revolute("A lower", m.ground, body["AH"], point=A)
    m.spring_damper("spring", (m.ground, C), (body["BDE"], points["D"]), stiffness=STIFFNESS, free_length=FREE_LENGTH)
    torque = m.input("motor.torque", start=TORQUE, unit="N.m", description="torque of the motor on OF")
    m.torque("motor", body["OF"], inputs=torque)
    for component in "xy":
        m.sense_position(
            f"F.position.{component}",
            body["OF"],
            points["F"],
            component,
            description=f"position of F along {component}",
        )
    m.sense_angle("OF.angle", body["OF"], "yaw", description="turn of OF since the start, wrapped")
    m.sense_energy("energy.total", "total", description="kinetic and elastic energy")
    return m


def _point_in_axes(origin: tuple[float, float], angle: float, x: float, y: float) -> tuple[float, float]:
    """Earth coordinates, m, of the point (x, y) in axes at `origin` that are rotated by `angle`, rad."""
    return (
        origin[0] + x * cos(angle) - y * sin(angle),
        origin[1] + x * sin(angle) + y * cos(angle),
    )
