"""A glTF file in the making: nodes, meshes, materials, animation, and the bytes that they name."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
from numpy.typing import NDArray

from viewer.gltf.materials import Look
from viewer.gltf.solids import Solid

_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_COMPONENTS = {"f4": pygltflib.FLOAT, "u4": pygltflib.UNSIGNED_INT, "u2": pygltflib.UNSIGNED_SHORT}
_GENERATOR = "ALi3"
_NOTHING = {
    "translation": np.zeros(3, dtype=np.float32),
    "rotation": np.array([1, 0, 0, 0], dtype=np.float32),
    "scale": np.ones(3, dtype=np.float32),
}


class Document:
    """Collects what a file holds; equal arrays and materials are kept once."""

    def __init__(self, name: str) -> None:
        self._gltf = pygltflib.GLTF2(
            asset=pygltflib.Asset(version="2.0", generator=_GENERATOR), scene=0, scenes=[pygltflib.Scene(name=name)]
        )
        self._gltf.scenes[0].nodes = []
        self._blob = bytearray()
        self._accessors: dict[tuple[Any, ...], int] = {}
        self._materials: dict[Look, int] = {}
        self._meshes: dict[str, int] = {}
        self._names: dict[str, int] = {}
        self._animation = pygltflib.Animation(name=name)

    def node(self, name: str, parent: int | None, mesh: int | None = None) -> int:
        """Add a node to another one or, without one, to the scene; a second one of a name has a number behind it."""
        self._names[name] = self._names.get(name, 0) + 1
        unique = name if self._names[name] == 1 else f"{name} ({self._names[name]})"
        self._gltf.nodes.append(pygltflib.Node(name=unique, mesh=mesh))
        index = len(self._gltf.nodes) - 1
        siblings = self._gltf.scenes[0].nodes if parent is None else self._gltf.nodes[parent].children
        siblings.append(index)
        return index

    def place(self, node: int, path: str, values: NDArray[Any]) -> None:
        """Set ``translation``, ``rotation`` (scalar first) or ``scale`` of a node, unless it has none."""
        numbers = values.astype(np.float32)
        if not np.array_equal(numbers, _NOTHING[path]):
            ordered = numbers[[1, 2, 3, 0]] if path == "rotation" else numbers
            setattr(self._gltf.nodes[node], path, ordered.astype(float).tolist())

    def report_origin(self, node: int, origin: NDArray[np.float64]) -> None:
        """Put what was taken from all places into the extras of the scene and of a node: earth axes, m."""
        for holder in (self._gltf.scenes[0], self._gltf.nodes[node]):
            holder.extras = {"origin": origin.tolist()}

    def set_weights(self, mesh: int, weights: NDArray[Any]) -> None:
        """Give a mesh with targets the weights that it has without an animation."""
        self._gltf.meshes[mesh].weights = weights.astype(np.float32).astype(float).tolist()

    def mesh(
        self,
        name: str,
        parts: Sequence[tuple[Solid, Look]],
        targets: Sequence[NDArray[np.float64]] = (),
    ) -> int:
        """Add a mesh of parts with a look each; `targets` are displacements of the positions of its only part."""
        primitives = []
        for solid, look in parts:
            attributes = pygltflib.Attributes(POSITION=self._vertices(solid.positions, bounds=True))
            if solid.normals is not None:
                attributes.NORMAL = self._vertices(solid.normals)
            if solid.colors is not None:
                attributes.COLOR_0 = self._vertices(solid.colors)
            primitive = pygltflib.Primitive(
                attributes=attributes, indices=self._indices(solid.triangles), material=self._material(look)
            )
            primitive.targets = [{"POSITION": self._vertices(target, bounds=True)} for target in targets]
            primitives.append(primitive)
        mesh = pygltflib.Mesh(name=name, primitives=primitives)
        if targets:
            mesh.weights = [0.0] * len(targets)
        key = json.dumps([p.to_dict() for p in primitives], default=str)
        if key not in self._meshes:
            self._gltf.meshes.append(mesh)
            self._meshes[key] = len(self._gltf.meshes) - 1
        return self._meshes[key]

    def channel(self, node: int, path: str, times: NDArray[Any], values: NDArray[Any]) -> None:
        """Animate a property of a node, linear between times; quaternions are given scalar first."""
        numbers = values[:, [1, 2, 3, 0]] if path == "rotation" else values
        sampler = pygltflib.AnimationSampler(
            input=self._accessor(times, bounds=True),
            output=self._accessor(numbers.ravel() if path == "weights" else numbers),
            interpolation="LINEAR",
        )
        self._animation.samplers.append(sampler)
        target = pygltflib.AnimationChannelTarget(node=node, path=path)
        self._animation.channels.append(
            pygltflib.AnimationChannel(sampler=len(self._animation.samplers) - 1, target=target)
        )

    def save(self, path: Path) -> None:
        """Write a ``.glb``, or a ``.gltf`` with the bytes in it."""
        gltf = self._gltf
        if self._animation.channels:
            gltf.animations = [self._animation]
        if any(material.extensions for material in gltf.materials):
            gltf.extensionsUsed = ["KHR_materials_clearcoat"]
        if self._blob:
            gltf.buffers = [pygltflib.Buffer(byteLength=len(self._blob))]
            gltf.set_binary_blob(bytes(self._blob))
        if path.suffix == ".glb":
            gltf.save_binary(path)
            return
        if self._blob:
            gltf.convert_buffers(pygltflib.BufferFormat.DATAURI)
        gltf.save_json(path)

    def _material(self, look: Look) -> int:
        if look not in self._materials:
            material = pygltflib.Material(
                name=look.name,
                pbrMetallicRoughness=pygltflib.PbrMetallicRoughness(
                    baseColorFactor=list(look.color), metallicFactor=look.metalness, roughnessFactor=look.roughness
                ),
                doubleSided=look.double or None,
            )
            material.alphaCutoff = None
            if look.color[3] < 1.0:
                material.alphaMode = "BLEND"
            if look.clearcoat is not None:
                factor, roughness = look.clearcoat
                material.extensions = {
                    "KHR_materials_clearcoat": {"clearcoatFactor": factor, "clearcoatRoughnessFactor": roughness}
                }
            self._gltf.materials.append(material)
            self._materials[look] = len(self._gltf.materials) - 1
        return self._materials[look]

    def _vertices(self, numbers: NDArray[Any], bounds: bool = False) -> int:
        return self._accessor(numbers, pygltflib.ARRAY_BUFFER, bounds)

    def _indices(self, triangles: NDArray[np.int64]) -> int:
        kind = "<u2" if int(triangles.max()) < 2**16 - 1 else "<u4"
        return self._accessor(triangles.ravel(), pygltflib.ELEMENT_ARRAY_BUFFER, kind=kind)

    def _accessor(
        self, numbers: NDArray[Any], target: int | None = None, bounds: bool = False, kind: str = "<f4"
    ) -> int:
        data = np.ascontiguousarray(numbers, dtype=kind)
        raw = data.tobytes()
        width = 1 if data.ndim == 1 else data.shape[1]
        key = (raw, kind, width, target, bounds)
        if key in self._accessors:
            return self._accessors[key]
        view = pygltflib.BufferView(buffer=0, byteOffset=len(self._blob), byteLength=len(raw), target=target)
        self._blob += raw + bytes(-len(raw) % 4)
        self._gltf.bufferViews.append(view)
        accessor = pygltflib.Accessor(
            bufferView=len(self._gltf.bufferViews) - 1,
            componentType=_COMPONENTS[kind[1:]],
            count=len(data),
            type=_TYPES[width],
        )
        if bounds:
            accessor.min = np.atleast_1d(data.min(axis=0)).astype(float).tolist()
            accessor.max = np.atleast_1d(data.max(axis=0)).astype(float).tolist()
        self._gltf.accessors.append(accessor)
        self._accessors[key] = len(self._gltf.accessors) - 1
        return self._accessors[key]
