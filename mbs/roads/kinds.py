"""Suffixes of files that roads are made of."""

TABLES = (".csv", ".txt")
PICTURE = ".png"
GRIDS = (*TABLES, ".npy", ".npz", PICTURE)
"""Endings of files that hold a grid of numbers."""
CRG = ".crg"
MESHES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
ROADS = (".road", ".toml", *GRIDS, CRG, *MESHES)
