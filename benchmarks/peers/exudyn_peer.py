"""The shared scenes in Exudyn: planar bodies with revolute joints and a sparse solver, or a kinematic tree.

Its compiled solver runs in one call a run; nothing is written but the position of the output point at the samples.
"""

from __future__ import annotations

import time
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface

from benchmarks.peers.common import PeerRun, samples_times
from mbs.scenes import bricard, spatial_chain

INTEGRATORS = ("generalised alpha", "generalised alpha (tree)", "trapezoidal index 2", "RK44 (tree)")
VERSION = exu.__version__


def scenes() -> tuple[str, ...]:
    """Names of the shared scenes."""
    return ("double_four_bar", "bricard", "spatial_chain", "four_bar_40", "four_bar_200")


def integrators(scene: str) -> tuple[str, ...]:
    """Those that make sense: explicit ones need a scene without loops; the trapezoidal rule of index 2 gives up at
    singular positions and with redundant rows.
    """
    if scene == "spatial_chain":
        return ("generalised alpha", "trapezoidal index 2", "RK44 (tree)")
    if scene == "double_four_bar":
        return ("generalised alpha", "generalised alpha (tree)")
    return ("generalised alpha",)


def run(scene: str, h: float, end: float, samples: int, integrator: str) -> PeerRun:
    """One run; the wall time is that of the solver's call."""
    explicit = integrator.startswith("RK44")
    if integrator not in integrators(scene):
        raise ValueError(f"{integrator!r} is not for {scene}")
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    if "four_bar" in scene:
        windows = int(scene.rpartition("_")[2]) if scene[-1].isdigit() else 2
        sensor = _four_bar_tree(mbs, windows) if "(tree)" in integrator else _four_bar(mbs, windows)
        large = windows > 10
    elif scene == "bricard":
        sensor, large = _bricard(mbs), False
    else:
        sensor, large = _chain(mbs), False
    mbs.Assemble()
    s = exu.SimulationSettings()
    s.timeIntegration.numberOfSteps = round(end / h)
    s.timeIntegration.endTime = end
    s.timeIntegration.verboseMode = 0
    s.show.statistics = False
    s.solution.file.write = False
    s.solution.sensors.writePeriod = end / samples
    s.timeIntegration.newton.useModifiedNewton = True
    s.timeIntegration.newton.relativeTolerance = 1e-8  # its default
    s.timeIntegration.newton.absoluteTolerance = 1e-10
    s.timeIntegration.generalizedAlpha.spectralRadius = 1.0 if integrator.startswith("trap") else 0.9
    s.timeIntegration.generalizedAlpha.useIndex2Constraints = integrator.startswith("trap")
    s.timeIntegration.generalizedAlpha.useNewmark = integrator.startswith("trap")
    s.linearSolver.ignoreSingularJacobian = scene == "bricard"
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse if large else exu.LinearSolverType.EXUdense
    if scene == "bricard":
        s.linearSolver.solverType = exu.LinearSolverType.EigenDense
    kind = exu.DynamicSolverType.RK44 if explicit else exu.DynamicSolverType.GeneralizedAlpha
    begin = time.perf_counter()
    try:
        finished = bool(mbs.SolveDynamic(s, solverType=kind, showHints=False, showCausingItems=False))
    except Exception:  # the engine raises its own kinds when Newton's method fails
        finished = False
    wall = time.perf_counter() - begin
    table = np.atleast_2d(mbs.GetSensorStoredData(sensor))
    planar = "four_bar" in scene
    count = min(len(table), samples + 1)
    return PeerRun(
        samples_times(end, samples)[:count],
        table[:count, 1 : 3 if planar else 4],
        None,
        wall,
        finished and count > samples,
    )


def _four_bar(mbs: Any, windows: int) -> int:
    ground = mbs.AddObject(itemInterface.ObjectGround())
    tips: list[int] = []
    first = None
    for i in range(windows + 1):
        body = _planar(mbs, (i, 0.5), (0.5, 0.0), -1.0)
        base = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[0, -0.5, 0]))
        foot = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=ground, localPosition=[i, 0, 0]))
        mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[base, foot]))
        tips.append(mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0.5, 0])))
        if first is None:
            first = mbs.AddSensor(
                itemInterface.SensorBody(
                    bodyNumber=body,
                    localPosition=[0, 0.5, 0],
                    storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Position,
                )
            )
    for i in range(windows):
        body = _planar(mbs, (i + 0.5, 1.0), (1.0, 0.0), 0.0)
        for side, tip in ((-0.5, tips[i]), (0.5, tips[i + 1])):
            end = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[side, 0, 0]))
            mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[end, tip]))
    return int(first)


def _four_bar_tree(mbs: Any, windows: int) -> int:
    """Cranks on the ground, couplers on the cranks before them; the far ends of the couplers close the loops."""
    up, right, z = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    n = 2 * windows + 1  # crank i is link i, coupler i is link windows + 1 + i
    offsets = [i * right for i in range(windows + 1)] + [up] * windows
    parents = [-1] * (windows + 1) + list(range(windows))
    rates = [-1.0] * (windows + 1) + [1.0] * windows
    alongs = [up] * (windows + 1) + [right] * windows
    tree, sensor = _tree(mbs, offsets, [z] * n, 1.0, 1.0, 0.0, alongs, [0, -9.81, 0], rates, (0, up), parents)
    R = _frame(z)
    for i in range(windows):
        far, tip = (
            mbs.AddMarker(
                itemInterface.MarkerKinematicTreeRigid(objectNumber=tree, linkNumber=link, localPosition=R.T @ place)
            )
            for link, place in ((windows + 1 + i, right), (i + 1, up))
        )
        mbs.AddObject(itemInterface.GenericJoint(markerNumbers=[far, tip], constrainedAxes=[1, 1, 0, 0, 0, 0]))
    return sensor


def _planar(mbs: Any, place: tuple[float, float], velocity: tuple[float, float], rate: float) -> int:
    node = mbs.AddNode(
        itemInterface.NodeRigidBody2D(referenceCoordinates=[*place, 0.0], initialVelocities=[*velocity, rate])
    )
    body = mbs.AddObject(itemInterface.ObjectRigidBody2D(physicsMass=1.0, physicsInertia=1.0 / 12.0, nodeNumber=node))
    centre = mbs.AddMarker(itemInterface.MarkerBodyMass(bodyNumber=body))
    mbs.AddLoad(itemInterface.LoadMassProportional(markerNumber=centre, loadVector=[0, -9.81, 0]))
    return int(body)


def _tree(
    mbs: Any,
    offsets: list[np.ndarray],
    axes: list[np.ndarray],
    mass: float,
    length: float,
    side: float,
    alongs: list[np.ndarray],
    gravity: list[float],
    rates: list[float],
    output: tuple[int, np.ndarray],
    parents: list[int] | None = None,
) -> tuple[int, int]:
    """A kinematic tree, by default one chain; joint axes as the third axis of each link's frame."""
    n = len(axes)
    parents = list(range(-1, n - 1)) if parents is None else parents
    frames = [_frame(a) for a in axes]  # columns: link axes in the reference configuration, z along the hinge
    before = [np.eye(3) if p < 0 else frames[p] for p in parents]
    node = mbs.AddNode(
        itemInterface.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=[0.0] * n,
            initialCoordinates_t=rates,
            numberOfODE2Coordinates=n,
        )
    )
    axial, transverse = mass * side**2 / 6.0, mass * (length**2 + side**2) / 12.0
    inertias, coms, transformations, places = (
        exu.Matrix3DList(),
        exu.Vector3DList(),
        exu.Matrix3DList(),
        exu.Vector3DList(),
    )
    for k in range(n):
        R = frames[k]
        local = R.T @ alongs[k]
        inertias.Append(transverse * np.eye(3) + (axial - transverse) * np.outer(local, local))
        coms.Append(0.5 * length * local)
        transformations.Append(before[k].T @ R)
        places.Append(before[k].T @ offsets[k])
    tree = mbs.AddObject(
        itemInterface.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[exu.JointType.RevoluteZ] * n,
            linkParents=parents,
            jointTransformations=transformations,
            jointOffsets=places,
            linkInertiasCOM=inertias,
            linkCOMs=coms,
            linkMasses=[mass] * n,
            baseOffset=[0.0, 0.0, 0.0],
            gravity=gravity,
        )
    )
    link, place = output
    sensor = mbs.AddSensor(
        itemInterface.SensorKinematicTree(
            objectNumber=tree,
            linkNumber=link,
            localPosition=frames[link].T @ place,
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.Position,
        )
    )
    return int(tree), int(sensor)


def _frame(axis: np.ndarray) -> np.ndarray:
    """Rotation matrix with the axis as its third column."""
    z = np.asarray(axis, float) / np.linalg.norm(axis)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _bricard(mbs: Any) -> int:
    b = bricard
    points = np.array(b.POINTS, float) * b.LENGTH
    alongs = [(points[k + 1] - points[k]) / b.LENGTH for k in range(5)]
    offsets = [points[0]] + [points[k] - points[k - 1] for k in range(1, 5)]
    axes = [np.array(a, float) for a in b.AXES[:5]]
    tree, sensor = _tree(
        mbs, offsets, axes, b.MASS, b.LENGTH, b.SECTION, alongs, [0, -9.81, 0], [0.0] * 5, (1, points[2] - points[1])
    )
    ground = mbs.AddObject(itemInterface.ObjectGround())
    R = _frame(axes[4])
    end = mbs.AddMarker(
        itemInterface.MarkerKinematicTreeRigid(
            objectNumber=tree, linkNumber=4, localPosition=R.T @ (points[5] - points[4])
        )
    )
    foot = mbs.AddMarker(itemInterface.MarkerBodyRigid(bodyNumber=ground, localPosition=points[5]))
    hinge = _frame(np.array(b.AXES[5], float))
    mbs.AddObject(
        itemInterface.GenericJoint(
            markerNumbers=[end, foot],
            constrainedAxes=[1, 1, 1, 1, 1, 0],
            rotationMarker0=R.T @ hinge,
            rotationMarker1=hinge,
        )
    )
    return sensor


def _chain(mbs: Any) -> int:
    s = spatial_chain
    along, square, across = s.directions()
    n = s.LINKS
    offsets = [np.zeros(3)] + [s.LENGTH * along] * (n - 1)
    axes = [across if k % 2 == 0 else square for k in range(n)]
    rates = [s.SPIN, s.SPIN] + [0.0] * (n - 2)
    return _tree(
        mbs, offsets, axes, s.MASS, s.LENGTH, s.SECTION, [along] * n, [0, 0, -9.81], rates, (n - 1, s.LENGTH * along)
    )[1]
