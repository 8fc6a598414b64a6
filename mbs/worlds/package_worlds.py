"""Worlds and roads of the package."""

from pathlib import Path

WORLDS = Path(__file__).parent
ROADS = Path(__file__).parents[1] / "roads" / "files"


def world_names() -> list[str]:
    """Names of the worlds and roads of the package."""
    return [path.stem for path in sorted(WORLDS.glob("*.toml"))] + [path.stem for path in sorted(ROADS.glob("*.road"))]
