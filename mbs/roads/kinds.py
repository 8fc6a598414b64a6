"""Suffixes of files that roads are made of."""

TABLES = (".csv", ".txt")
PICTURE = ".png"
GRIDS = (*TABLES, ".npy", ".npz", PICTURE)
"""Of grids of numbers."""
CRG = ".crg"
MESHES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
ROADS = (".road", ".toml", *GRIDS, CRG, *MESHES)
