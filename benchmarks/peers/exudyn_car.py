"""A car of the same mass, wheel positions, wheel rates and damping in Exudyn: a kinematic tree of 16 coordinates.

Each wheel slides vertically on a spring and rolls by Exudyn's `ObjectConnectorRollingDiscPenalty`: a normal penalty
force with the tyre's stiffness, and a friction force proportional to the slip speed up to a maximum. The slip speed at
the maximum gives the initial cornering stiffness of ALi3's tyre. There are no suspension links, no drive and no air. A
Python function sets the angles of the front wheels before each step, as is usual in Exudyn.
"""

import time
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface
from numpy.typing import NDArray

from mbs.vehicle.car import Car
from mbs.vehicle.tyres.tmeasy import TMeasy

Array = NDArray[np.float64]
GRAVITY = 9.81  # m/s2
STEERING = 2e4, 200.0  # N m/rad, N m s/rad: stiffness and damping of the angle control of a front wheel
TOLERANCES = 1e-4, 1e-6  # of Newton's method; with its defaults a path of 60 m changes by 0.02 mm
# indices of coordinates: x, y, z, yaw, pitch, roll of the body come first
YAW = 3
ROLL = 5
AXLES = ("front", "rear")


class ExudynCar:
    """The assembled car, which starts in equilibrium on its springs, rolling.

    Parameters
    ----------
    mass : float
        Mass of the whole car, kg; the body has what the wheels do not have.
    speed : float
        Initial speed, m/s.
    h : float
        Step, s.
    angles : ndarray, shape (steps, 2)
        Angles of the front wheels, left and right, at the end of each step, rad.
    rates : dict of str to float
        Result of `benchmarks.car.rig.kinematics`.
    """

    def __init__(self, car: Car, mass: float, speed: float, h: float, angles: Array, rates: dict[str, float]) -> None:
        self.h, self.angles, self.grip = h, angles, car.road.friction
        self._container = exu.SystemContainer()
        self.mbs = self._container.AddSystem()
        joint, body, axles = exu.JointType, car.chassis, dict(zip(AXLES, (car.front, car.rear), strict=True))
        unsprung = 2.0 * sum(axle.wheel.mass for axle in axles.values())
        x, _, z = body.com
        ahead = x - car.rear.wheel.centre[0]
        tree = _Tree()
        for kind in (joint.PrismaticX, joint.PrismaticY, joint.PrismaticZ, joint.RevoluteZ, joint.RevoluteY):
            tree.add(kind, rate=0.0 if tree.types else speed, offset=(0.0, 0.0, 0.0) if tree.types else (x, 0.0, z))
        base = tree.add(joint.RevoluteX, mass=mass - unsprung, inertia=body.inertia)
        self.discs: list[tuple[int, float, float, TMeasy]] = []
        steered = []
        for name, axle in axles.items():
            wheel, tyre = axle.wheel, axle.tyre
            assert isinstance(tyre, TMeasy)
            assert axle.damper.damping is not None
            lever = ahead if name == "front" else car.wheelbase - ahead
            load = GRAVITY * (mass - unsprung) * lever / car.wheelbase / 2.0
            stiffness = rates[f"{name}.wheel_rate"]
            damping = axle.damper.damping * rates[f"{name}.spring_ratio"] ** 2
            tyre_load = load + GRAVITY * wheel.mass
            radius = wheel.centre[2] + tyre_load / tyre.stiffness
            for side in (1.0, -1.0):
                offset = (wheel.centre[0] - x, side * wheel.centre[1], wheel.centre[2] - z)
                tree.add(joint.PrismaticZ, parent=base, offset=offset, spring=(stiffness, damping, -load / stiffness))
                if name == "front":
                    steered.append(tree.add(joint.RevoluteZ, spring=(*STEERING, 0.0)))
                inertia = (wheel.diametral_inertia, wheel.spin_inertia, wheel.diametral_inertia)
                spin = tree.add(joint.RevoluteY, mass=wheel.mass, inertia=inertia, rate=speed / radius)
                self.discs.append((spin, radius, tyre_load, tyre))
        node, number = tree.assemble(self.mbs)
        self._add_contacts(number, speed)
        kinds = exu.OutputVariableType
        self._sensors = [
            self.mbs.AddSensor(itemInterface.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))
            for kind in (kinds.Coordinates, kinds.Coordinates_t)
        ]
        targets = np.array([spring[2] for spring in tree.springs])

        def steer(mbs: Any, t: float) -> bool:
            targets[steered] = angles[min(round(t / h), len(angles) - 1)]
            mbs.SetObjectParameter(number, "jointPositionOffsetVector", targets)
            return True

        self.mbs.SetPreStepUserFunction(steer)
        self.mbs.Assemble()

    def _add_contacts(self, tree: int, speed: float) -> None:
        """Add the rolling contacts of the wheels with the plane z = 0."""
        ground = self.mbs.AddObject(itemInterface.ObjectGround())
        plane = self.mbs.AddMarker(itemInterface.MarkerBodyRigid(bodyNumber=ground))
        for link, radius, load, tyre in self.discs:
            wheel = itemInterface.MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=link)
            start = [0.0, 0.0, -load / tyre.stiffness]
            data = itemInterface.NodeGenericData(initialCoordinates=start, numberOfDataCoordinates=3)
            friction = self.grip * tyre.lateral.max_force[0] / (tyre.nominal_load * tyre.reference_friction)
            self.mbs.AddObject(
                itemInterface.ObjectConnectorRollingDiscPenalty(
                    markerNumbers=[plane, self.mbs.AddMarker(wheel)],
                    nodeNumber=self.mbs.AddNode(data),
                    discRadius=radius,
                    discAxis=[0, 1, 0],
                    contactStiffness=tyre.stiffness,
                    contactDamping=tyre.damping,
                    dryFriction=[friction, friction],
                    dryFrictionProportionalZone=speed * friction * tyre.nominal_load / tyre.lateral.slope[0],
                    useLinearProportionalZone=True,
                )
            )

    def drive(self) -> tuple[Array, Array, float]:
        """Coordinates and their rates after each step, shapes (steps, 16), and the processor time, s."""
        s = exu.SimulationSettings()
        s.timeIntegration.numberOfSteps = len(self.angles)
        s.timeIntegration.endTime = self.h * len(self.angles)
        s.timeIntegration.verboseMode = 0
        s.timeIntegration.newton.useModifiedNewton = True
        s.timeIntegration.newton.relativeTolerance, s.timeIntegration.newton.absoluteTolerance = TOLERANCES
        s.timeIntegration.generalizedAlpha.spectralRadius = 0.9
        s.solution.file.write = False
        s.solution.sensors.writePeriod = self.h
        s.linearSolver.solverType = exu.LinearSolverType.EXUdense
        begin = time.process_time()
        self.mbs.SolveDynamic(s, solverType=exu.DynamicSolverType.GeneralizedAlpha, showHints=False)
        spent = time.process_time() - begin
        results, rates = (np.asarray(self.mbs.GetSensorStoredData(k))[1:, 1:] for k in self._sensors)
        return results, rates, spent


def drive(
    car: Car, mass: float, speed: float, h: float, angles: Array, rates: dict[str, float], cars: int
) -> tuple[Array, float]:
    """Simulate several cars one after the other, whose springs differ by 1 % from one to the next.

    `mass`, `speed`, `h`, `angles`, `rates`: see `ExudynCar`.

    Returns
    -------
    rates : ndarray, shape (steps, 16)
        Rates of the coordinates of the first car.
    seconds : float
        Processor time without the assembly.
    """
    spent, first = 0.0, np.empty(0)
    for number in range(cars):
        varied = rates | {f"{axle}.wheel_rate": rates[f"{axle}.wheel_rate"] * (1.0 + 0.01 * number) for axle in AXLES}
        _, states, used = ExudynCar(car, mass, speed, h, angles, varied).drive()
        first, spent = states if number == 0 else first, spent + used
    return first, spent


class _Tree:
    """Links of a kinematic tree, each on the previous one or on `parent`."""

    def __init__(self) -> None:
        self.types: list[Any] = []
        self.parents: list[int] = []
        self.offsets: list[tuple[float, ...]] = []
        self.masses: list[float] = []
        self.inertias: list[tuple[float, ...]] = []
        self.springs: list[tuple[float, float, float]] = []
        self.rates: list[float] = []

    def add(
        self,
        kind: Any,
        *,
        parent: int | None = None,
        offset: tuple[float, ...] = (0.0, 0.0, 0.0),
        mass: float = 0.0,
        inertia: tuple[float, ...] = (0.0, 0.0, 0.0),
        spring: tuple[float, float, float] = (0.0, 0.0, 0.0),
        rate: float = 0.0,
    ) -> int:
        """Add a link; returns its number. `spring`: stiffness, damping and unloaded position of its coordinate."""
        self.parents.append(len(self.types) - 1 if parent is None else parent)
        for values, value in zip(
            (self.types, self.offsets, self.masses, self.inertias, self.springs, self.rates),
            (kind, offset, mass, inertia, spring, rate),
            strict=True,
        ):
            values.append(value)
        return len(self.types) - 1

    def assemble(self, mbs: Any) -> tuple[int, int]:
        """Add the tree to a system of Exudyn; numbers of its node and of itself."""
        n = len(self.types)
        node = mbs.AddNode(
            itemInterface.NodeGenericODE2(
                referenceCoordinates=[0.0] * n,
                initialCoordinates=[0.0] * n,
                initialCoordinates_t=self.rates,
                numberOfODE2Coordinates=n,
            )
        )
        stiffness, damping, targets = (list(column) for column in zip(*self.springs, strict=True))
        tree = mbs.AddObject(
            itemInterface.ObjectKinematicTree(
                nodeNumber=node,
                jointTypes=self.types,
                linkParents=self.parents,
                jointTransformations=exu.Matrix3DList([np.eye(3)] * n),
                jointOffsets=exu.Vector3DList([np.array(offset) for offset in self.offsets]),
                linkInertiasCOM=exu.Matrix3DList([np.diag(inertia) for inertia in self.inertias]),
                linkCOMs=exu.Vector3DList([np.zeros(3)] * n),
                linkMasses=self.masses,
                gravity=[0.0, 0.0, -GRAVITY],
                jointPControlVector=stiffness,
                jointDControlVector=damping,
                jointPositionOffsetVector=targets,
                jointVelocityOffsetVector=[0.0] * n,
            )
        )
        return int(node), int(tree)
