"""Recordings as glTF 2.0 animations, which Blender, three.js, Windows and macOS show."""

from viewer.gltf.write import WrittenGltf, write_gltf

__all__ = ["WrittenGltf", "write_gltf"]
