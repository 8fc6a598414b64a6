"""Builds the FMU of a scene: ``python build_fmu.py [--scene NAME or path/to/file.py:function] [--out DIR]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python build_fmu.py", description="Build the FMU of a scene.")
    parser.add_argument(
        "--scene",
        default="prototype_car",
        metavar="NAME",
        help="a scene of mbs.scenes, or path/to/file.py:function (a function that returns an mbs.Model or mbs.System); "
        "default: prototype_car",
    )
    parser.add_argument("--out", type=Path, default=Path("dist"), metavar="DIR", help="default: dist")
    parser.add_argument(
        "--platforms", default="linux64,win64", metavar="LIST", help="out of linux64 and win64; default: both"
    )
    options = parser.parse_args(arguments)
    try:
        import pythonfmu  # noqa: F401
    except ImportError:
        print('error: PythonFMU is not installed; run: pip install "ali3[fmu]"', file=sys.stderr)
        return 2
    from fmu_src.build import build_fmu
    from fmu_src.scene_registry import load_variants

    try:
        print(f"scene {options.scene} ...", flush=True)
        name, systems, fidelity = load_variants(options.scene)
        platforms = options.platforms.split(",")
        file = build_fmu(systems, name, options.out, platforms, lambda text: print(text, flush=True), fidelity)
        system = systems[fidelity]
    except (ValueError, RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(
        f"{file}: {file.stat().st_size / 1e6:.1f} MB, {len(system.meta['inputs'])} inputs, "
        f"{len(system.meta['sensors'])} outputs"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
