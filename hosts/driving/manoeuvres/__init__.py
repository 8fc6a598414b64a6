"""The manoeuvres that come with the hosts, and their names."""

from pathlib import Path

FOLDER = Path(__file__).parent


def manoeuvre_names() -> list[str]:
    """Names of the manoeuvres, sorted."""
    return sorted({p.stem for p in FOLDER.iterdir() if p.suffix in (".toml", ".csv")})
