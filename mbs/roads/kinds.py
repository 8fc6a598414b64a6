"""Suffixes of the files from which roads are read."""

TABLES = (".csv", ".txt")
PICTURE = ".png"
GRIDS = (*TABLES, ".npy", ".npz", PICTURE)
"""Files that hold a grid of numbers."""
CRG = ".crg"
MESHES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
ROADS = (".road", ".toml", *GRIDS, CRG, *MESHES)
