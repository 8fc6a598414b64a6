"""Computes the references with geometrically exact beams: a separate program that needs Exudyn and NumPy.

``pip install exudyn numpy; python exudyn_beams.py {four_bar,spin_up,pendulum} ELEMENTS STEP FILE``. Beams on SE(3)
(`ObjectBeamGeometricallyExact`), generalised-alpha. The stored files were made with Exudyn 1.13.6:
`assembly_defect.csv` by ``four_bar 16 2.5e-3`` (elements per 0.12 m), `spin_up_beam.csv` by
``spin_up 16 5e-3``, `falling_flexible_pendulum.csv` by ``pendulum 32 1e-3``.
"""

import sys
from math import cos, pi

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    LoadMassProportional,
    MarkerBodyMass,
    MarkerBodyRigid,
    MarkerNodeRigid,
    NodeRigidBodyEP,
    ObjectBeamGeometricallyExact,
    ObjectGround,
    ObjectJointGeneric,
    SensorBody,
    SensorNode,
)
from exudyn.rigidBodyUtilities import AngularVelocity2EulerParameters_t, RotationMatrix2EulerParameters

OUT_OF_PLANE = np.array([0.0, 0.0, 1.0])


def round_section(E, nu, rho, radius, damping):
    """Section of a round bar with the shear factor of the circle; `damping`: over stiffness, s."""
    A, I = pi * radius**2, pi * radius**4 / 4
    G = E / 2 / (1 + nu)
    k = 6 * (1 + nu) / (7 + 6 * nu)
    return section(np.diag([E * A, k * G * A, k * G * A, 2 * G * I, E * I, E * I]), rho * A, rho * I, damping)


def section(stiffness, mass, inertia, damping=0.0):
    """Section with stiffness (6, 6), mass, kg/m, and second moment of mass about a diameter, kg m."""
    s = exu.BeamSection()
    s.stiffnessMatrix, s.dampingMatrix = stiffness, damping * stiffness
    s.inertia, s.massPerLength = np.diag([2 * inertia, inertia, inertia]), mass
    return s


class Scene:
    """A system of Exudyn and functions that add to it."""

    def __init__(self):
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(ObjectGround())

    def bar(self, start, end, elements, section, velocity=(0, 0, 0), omega=(0, 0, 0)):
        """Add a bar; its nodes (x along the bar, z out of the plane), its elements, and the axes of the nodes (3,
        3).
        """
        start, end, omega = np.array(start, float), np.array(end, float), np.array(omega, float)
        along = (end - start) / np.linalg.norm(end - start)
        axes = np.array([along, np.cross(OUT_OF_PLANE, along), OUT_OF_PLANE]).T
        e = RotationMatrix2EulerParameters(axes)
        nodes = []
        for k in range(elements + 1):
            x = start + (end - start) * k / elements
            rates = [*(velocity + np.cross(omega, x - start)), *AngularVelocity2EulerParameters_t(omega, e)]
            nodes.append(
                self.mbs.AddNode(NodeRigidBodyEP(referenceCoordinates=[*x, *e], initialVelocities=[*map(float, rates)]))
            )
        length = float(np.linalg.norm(end - start)) / elements
        beams = [
            self.mbs.AddObject(
                ObjectBeamGeometricallyExact(nodeNumbers=[nodes[k], nodes[k + 1]], length=length, sectionData=section)
            )
            for k in range(elements)
        ]
        return nodes, beams, axes

    def on_node(self, node):
        """Add a marker at a node."""
        return self.mbs.AddMarker(MarkerNodeRigid(nodeNumber=node))

    def on_ground(self, point):
        """Add a marker at a point of the ground."""
        return self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.ground, localPosition=[*map(float, point)]))

    def hinge(self, marker_0, axes_0, marker_1, axes_1, axis=OUT_OF_PLANE, angle=None):
        """Add a revolute joint about an axis (earth axes), driven if `angle`, a function of time, is given."""
        z = np.array(axis, float) / np.linalg.norm(axis)
        x = np.cross([0.0, 1.0, 0.0], z)
        x /= np.linalg.norm(x)
        frame = np.array([x, np.cross(z, x), z]).T
        self.mbs.AddObject(
            ObjectJointGeneric(
                markerNumbers=[marker_0, marker_1],
                constrainedAxes=[1, 1, 1, 1, 1, int(angle is not None)],
                rotationMarker0=axes_0.T @ frame,
                rotationMarker1=axes_1.T @ frame,
                offsetUserFunction=0 if angle is None else lambda mbs, t, n, offset: [0, 0, 0, 0, 0, angle(t)],
            )
        )

    def solve(self, end, step, interval, spectral_radius):
        """Integrate up to `end`, s; sensors are recorded every `interval`, s."""
        self.mbs.Assemble()
        s = exu.SimulationSettings()
        s.timeIntegration.numberOfSteps = round(end / step)
        s.timeIntegration.endTime = end
        s.timeIntegration.generalizedAlpha.spectralRadius = spectral_radius
        s.timeIntegration.newton.useModifiedNewton = False
        s.timeIntegration.newton.relativeTolerance = 1e-7
        s.timeIntegration.newton.absoluteTolerance = 1e-9
        s.solutionSettings.writeSolutionToFile = False
        s.solutionSettings.sensorsWritePeriod = interval
        s.linearSolverType = exu.LinearSolverType.EigenSparse
        self.mbs.SolveDynamic(s)


def four_bar(elements, step):
    """Four-bar with assembly defect: T, My, Mz in the middle of the coupler, N m, and the position of joint C, m."""
    scene, speed, tilt = Scene(), -1.0, np.radians(5.0)
    s = round_section(7e10, 0.33, 3000.0, 0.005, 2.7e-5)
    A, B, C, D = (0, 0, 0), (0, 0.12, 0), (0.24, 0.12, 0), (0.24, 0, 0)
    w = speed * OUT_OF_PLANE
    crank, _, axes_1 = scene.bar(A, B, elements, s, omega=w)
    coupler, beams, axes_2 = scene.bar(B, C, 2 * elements, s, velocity=np.cross(w, np.subtract(B, A)))
    follower, _, axes_3 = scene.bar(D, C, elements, s, omega=w)
    scene.hinge(scene.on_ground(A), np.eye(3), scene.on_node(crank[0]), axes_1, angle=lambda t: speed * t)
    scene.hinge(scene.on_node(crank[-1]), axes_1, scene.on_node(coupler[0]), axes_2)
    tilted = (np.sin(tilt), 0.0, np.cos(tilt))
    scene.hinge(scene.on_node(coupler[-1]), axes_2, scene.on_node(follower[-1]), axes_3, tilted)
    scene.hinge(scene.on_ground(D), np.eye(3), scene.on_node(follower[0]), axes_3)
    kind = exu.OutputVariableType
    moments = [
        scene.mbs.AddSensor(
            SensorBody(bodyNumber=b, localPosition=[0, 0, 0], outputVariableType=kind.TorqueLocal, storeInternal=True)
        )
        for b in beams[elements - 1 : elements + 1]
    ]
    position = scene.mbs.AddSensor(
        SensorNode(nodeNumber=coupler[-1], outputVariableType=kind.Position, storeInternal=True)
    )
    scene.solve(10.0, step, 0.01, 0.6)
    left, right, c = (scene.mbs.GetSensorStoredData(k) for k in (*moments, position))
    # the middle is a node: mean of the elements on both sides
    return "t,T,My,Mz,C_x,C_y,C_z", np.column_stack([left[:, 0], (left[:, 1:] + right[:, 1:]) / 2, c[:, 1:]])


def spin_angle(t):
    """Angle of the hub, rad, that reaches 6 rad/s within 15 s; source: Simo and Vu-Quoc 1986."""
    return 6 * t - 45 if t > 15 else 6 / 15 * (t**2 / 2 + (15 / 2 / pi) ** 2 * (cos(2 * pi * t / 15) - 1))


def spin_up(elements, step):
    """Extension and deflection of the tip in the axes of the hub, m."""
    scene = Scene()
    s = section(np.diag([2.8e7, 1e7, 1e7, 1e4, 1.4e4, 1.4e4]), 1.2, 6e-4)
    nodes, _, axes = scene.bar((0, 0, 0), (10, 0, 0), elements, s)
    scene.hinge(scene.on_ground((0, 0, 0)), np.eye(3), scene.on_node(nodes[0]), axes, angle=spin_angle)
    t, x, y = tip(scene, nodes[-1], 20.0, step, 0.05)
    angle = np.array([spin_angle(v) for v in t])
    along, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    return "t,extension,deflection", np.column_stack([t, along - 10, across])


def pendulum(elements, step):
    """Position of the tip of a soft bar that falls from the horizontal, m."""
    scene = Scene()
    s = round_section(5e8, 0.3, 2000.0, 0.01, 0.0)
    nodes, beams, axes = scene.bar((0, 0, 0), (1, 0, 0), elements, s)
    scene.hinge(scene.on_ground((0, 0, 0)), np.eye(3), scene.on_node(nodes[0]), axes)
    for b in beams:
        marker = scene.mbs.AddMarker(MarkerBodyMass(bodyNumber=b))
        scene.mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=[0, -9.81, 0]))
    return "t,x,y", np.column_stack(tip(scene, nodes[-1], 2.0, step, 0.01))


def tip(scene, node, end, step, interval):
    """Run a scene; times, s, and x, y of a node, m."""
    kind = exu.OutputVariableType.Position
    sensor = scene.mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=kind, storeInternal=True))
    scene.solve(end, step, interval, 0.95)
    return scene.mbs.GetSensorStoredData(sensor)[:, :3].T


if __name__ == "__main__":
    header, data = {"four_bar": four_bar, "spin_up": spin_up, "pendulum": pendulum}[sys.argv[1]](
        int(sys.argv[2]), float(sys.argv[3])
    )
    np.savetxt(sys.argv[4], data, delimiter=",", fmt="%.8g", header=header, comments="")
