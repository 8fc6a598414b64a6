"""Rack, pinion and column with a torsion bar, power assistance and friction, turned by an angle or by a torque."""

import math
from collections.abc import Callable, Iterator
from typing import ClassVar, Literal

from mbs.elements.coordinate_friction import CoordinateFriction
from mbs.elements.input_force import InputForce
from mbs.elements.spring_damper import EndStops
from mbs.elements.torsion_bar import TorsionBar
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.joint_ends import End
from mbs.model.model import Model
from mbs.model.records import DrivingFunction, Input
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import new_port
from mbs.vehicle.quantities import (
    AssistanceFactor,
    AssistanceTorque,
    ColumnDamping,
    ColumnStiffness,
    OneOrZero,
    PartMass,
    PinionPerTurn,
    RackFriction,
    SteeringFriction,
    SteeringWheelInertia,
)
from mbs.vehicle.side import Point, Side
from mbs.vehicle.steering.rack_section import RackSection
from mbs.vehicle.steering.steering_outputs import RACK_FORCE, WHEEL_ANGLE, WHEEL_SPEED, WHEEL_TORQUE, demand_outputs
from mbs.vehicle.steering.steering_section import COLUMN_STICK, Steered

MAX_HAND_TORQUE = 100.0  # N m, of the driver
MAX_ACTUATOR_FORCE = 3e4  # N, on the rack
RACK_STICK = 5e6, 1e4  # N/m, N s/m of a sticking rack: 300 N displace it by 0.06 mm
STOP_STIFFNESS = 2e6  # N/m, of the stops of the rack
STOP_LOSS = 1.0  # s/m, of the stops of the rack
STOP_LENGTH = 1.0  # m, of the line along which the stops of the rack act, as drawn
RACK_RADIUS = 0.013  # m, for the inertia of the rack


class Column(RackSection, of=TorsionBar):
    """Rack, pinion, torsion bar and steering wheel, which the driver holds at an angle or turns by a torque."""

    without_travel: ClassVar[str] = "whose rack is a body"
    rack_port: ClassVar[str] = "rack_force"

    kind: Literal["column"]
    """Names this template."""
    rack_per_turn: PinionPerTurn
    """Travel of the rack per turn of the steering wheel."""
    rack_mass: PartMass
    """Mass of the rack."""
    rack_friction: RackFriction = 0.0
    """Friction of the rack in its housing and in the gear."""
    wheel_inertia: SteeringWheelInertia
    """Moment of inertia of the steering wheel about its axis."""
    friction: SteeringFriction = 0.0
    """Friction of the column at the steering wheel."""
    stiffness: ColumnStiffness
    damping: ColumnDamping = TorsionBar.damping
    assistance: AssistanceFactor = TorsionBar.assistance
    assistance_limit: AssistanceTorque = TorsionBar.assistance_limit
    by_torque: OneOrZero = 0.0
    """1: steering_torque turns a free steering wheel; 0: the steering wheel follows steering and its angle demand."""

    def faults(self) -> Iterator[str]:
        """Fault of an assistance without a limit."""
        if self.assistance > 0.0 and "assistance_limit" not in self.model_fields_set:
            yield (
                f"{self.key('assistance_limit')} is missing; without it {self.key('assistance')}, {self.assistance:g}, "
                "has no effect: it must be the largest torque of the assistance, N.m."
            )

    @property
    def on_flexible_chassis(self) -> bool:
        """False: the housing of the rack is rigid."""
        return False

    @property
    def moving_mass(self) -> float:
        """Mass of the rack, kg."""
        return self.rack_mass

    def build(self, b: CarBuilder, way: float) -> Steered:
        """Add column and steering wheel; the rack is added with its first end. `way`: as in `signed`."""
        m, per_radian = b.m, way * self.rack_per_turn / (2.0 * math.pi)
        demand = self.angle_demand(m)
        torque = m.input(
            "steering_torque",
            min=-MAX_HAND_TORQUE,
            max=MAX_HAND_TORQUE,
            unit="N.m",
            description="torque of the driver's hands where steering.by_torque is 1, positive to the left",
        )
        wheel, pinion = m.shaft("steering wheel", inertia=self.wheel_inertia), m.shaft("pinion")
        guide = self._add_hands(b, wheel, demand, torque)
        self._add_torsion_bar(b, wheel, pinion)
        if b.ports.steering is not None:
            text = "force of an actuator on the rack, positive to the left"
            force = new_port(b, "steering_rack_actuator_force", -MAX_ACTUATOR_FORCE, MAX_ACTUATOR_FORCE, "N", text)
            m.add(InputForce(force.index, (per_radian,)).record("port rack", (pinion.affine,)))
        racks: list[Body] = []

        def end(side: Side, point: Point) -> End:
            if not racks:
                racks.append(self._add_rack(b, pinion, point, per_radian))
            return racks[0], point

        return Steered(
            end,
            lambda: self._add_outputs(m, wheel, pinion, per_radian, way),
            self._torque_outputs(m, wheel, racks, demand, torque, guide),
        )

    def _add_hands(self, b: CarBuilder, wheel: Coordinate, demand: Input, torque: Input) -> DrivingFunction:
        """Add massless hands, which follow the demand or apply the torque; return their driving function."""
        m, largest = b.m, self.wheel_angle_max
        guide = m.guide_inputs(
            "steering wheel",
            inputs=(b.inputs["steering"], demand),
            gains=(largest, 1.0),
            limits=(-largest, largest),
            frequency=self.frequency,
            unit="rad",
        )
        hands = m.shaft("hands")
        m.gear("grip", wheel, hands, ratio=1.0)
        m.torque_on("steering torque", hands, input=torque)
        m.drive("steering angle", hands, guide, switch=True)
        b.tie(self, "by_torque", "steering angle", "on", -1.0, offset=1.0)
        # a free steering wheel would be in equilibrium at any angle where friction holds it
        m.equilibrium_parameters[self.key("by_torque")] = 0.0
        return guide

    def _add_torsion_bar(self, b: CarBuilder, wheel: Coordinate, pinion: Coordinate) -> None:
        """Add the torsion bar and the friction of the column."""
        bar = self.element(TorsionBar)
        b.tie_numbers(self, b.m.add(bar.record("torsion bar", wheel.affine, pinion.affine)))
        friction = CoordinateFriction(self.friction, *COLUMN_STICK)
        b.m.add(friction.record("steering friction", wheel.affine))
        b.tie(self, "friction", "steering friction", "largest")

    def _add_rack(self, b: CarBuilder, pinion: Coordinate, left: Point, per_radian: float) -> Body:
        """Add the rack with friction and stops. `left`: inner end of the left tie rod, m; `per_radian`: m/rad."""
        m, chassis, length = b.m, b.chassis.frame, 2.0 * abs(left[1])
        middle, across = (left[0], 0.0, left[2]), self.rack_mass * length**2 / 12.0
        inertia = (across, self.rack_mass * RACK_RADIUS**2, across)
        rack = m.body("rack", mass=self.rack_mass, com=middle, inertia=inertia)
        m.prismatic("rack housing", rack, chassis, axis=LEFT, point=middle)
        m.rack("pinion", pinion, rack, carrier=chassis, axis=LEFT, radius=per_radian, point=middle)
        friction = CoordinateFriction(self.rack_friction, *RACK_STICK, unit="N")
        m.add(friction.record("rack friction", pinion.affine * per_radian))
        b.tie(self, "rack_friction", "rack friction", "largest")
        ends = (rack, middle), (chassis, (middle[0], STOP_LENGTH, middle[2]))
        stops = EndStops(
            STOP_LENGTH - self.rack_travel,
            STOP_STIFFNESS,
            STOP_LENGTH + self.rack_travel,
            STOP_STIFFNESS,
            bump_loss=STOP_LOSS,
            rebound_loss=STOP_LOSS,
        )
        m.spring_damper("rack stop", *ends, stiffness=0.0, free_length=STOP_LENGTH, stops=stops)
        return rack

    def _add_outputs(self, m: Model, wheel: Coordinate, pinion: Coordinate, per_radian: float, way: float) -> None:
        """Add the travel of the rack and the angle of the steering wheel."""
        m.sense_coordinate("steering_rack", pinion, scale=per_radian, unit="m", description=self.travel_text(way))
        m.sense_coordinate("steering_wheel_angle", wheel, description=WHEEL_ANGLE)

    def _torque_outputs(
        self, m: Model, wheel: Coordinate, racks: list[Body], demand: Input, torque: Input, guide: DrivingFunction
    ) -> Callable[[], None]:
        """Function that adds the outputs of speeds, forces and torques when rack and tie rods are in the model."""

        def add() -> None:
            (rack,) = racks
            rods = [j for j in m.joints if j.type == "distance" and j.ends is not None and rack in j.ends.bodies]
            m.sense_joint("steering_wheel_torque", "grip", "torque", unit="N.m", description=WHEEL_TORQUE)
            m.sense_coordinate("steering_wheel_speed", wheel, order=1, description=WHEEL_SPEED)
            m.sense_rod_force("steering_rack_force", rods, rack, LEFT, description=RACK_FORCE)
            demand_outputs(m, demand, guide, 1.0)
            m.sense_input(f"used.{torque.name}", torque, description=f"{torque.name} as used")
            m.sense_element("steering_column_torque", "torsion bar", "torque", description="torque of the torsion bar")
            m.sense_element(
                "steering_assistance", "torsion bar", "assistance", description="torque of the assistance on the pinion"
            )
            names = ("steering torque", "torsion bar", "steering friction", "rack friction", "rack stop")
            m.sense_energy(
                "energy.steering",
                "with guides",
                [e for e in m.elements if e.name in names],
                description="work of the driver, by angle or steering_torque, of assistance, friction and stops of the "
                "steering since the start, without what is stored",
            )

        return add
