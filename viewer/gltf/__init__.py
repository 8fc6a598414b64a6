"""Recordings as glTF 2.0 animations, which Blender, three.js, Windows and macOS show."""

from ali3.scene.written_file import WrittenGltf
from viewer.gltf.write import write_gltf

__all__ = ["WrittenGltf", "write_gltf"]
