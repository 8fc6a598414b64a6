"""Builds the FMUs of a scene: ``python build_fmu.py [--scene NAME or path/to/file.py:function] [--kind LIST]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python build_fmu.py", description="Build the FMUs of a scene.")
    parser.add_argument(
        "--scene",
        default="prototype_car",
        metavar="NAME",
        help="a scene of mbs.scenes, or path/to/file.py:function (a function that returns an mbs.Model or mbs.System); "
        "default: prototype_car",
    )
    parser.add_argument("--out", type=Path, default=Path("dist"), metavar="DIR", help="default: dist")
    parser.add_argument(
        "--kind",
        "--only",
        default="native,fmi3,python",
        metavar="LIST",
        help="native (FMI 2.0 in C), fmi3 (FMI 3.0 in C), python (FMI 2.0, runs in the host's Python); default: these; "
        "fmi3_scalar: FMI 3.0 without arrays, for hosts that read them as zeros",
    )
    parser.add_argument(
        "--platforms",
        metavar="LIST",
        help="out of linux64, win64, darwin64 and aarch64-linux; default: all that the kind can have",
    )
    parser.add_argument("--author", default="", help="of the model, for its description; default: the solver's authors")
    parser.add_argument("--copyright", default="", help="of the model; default: the solver's")
    parser.add_argument("--license", default="", help="of the model; default: the solver's")
    options = parser.parse_args(arguments)
    from fmu_src.build import KINDS, build_fmu
    from fmu_src.platforms import PLATFORMS, PYTHON_PLATFORMS
    from fmu_src.scene_registry import load_fidelities

    kinds = options.kind.split(",")
    platforms = options.platforms.split(",") if options.platforms else None
    try:
        if set(kinds) - set(KINDS):
            raise ValueError(f"There is no kind of FMU '{options.kind}'; the kinds are {', '.join(KINDS)}.")
        if platforms and set(platforms) - set(PLATFORMS):
            raise ValueError(f"Platform '{options.platforms}' is not known; the platforms are {', '.join(PLATFORMS)}.")
        if "python" in kinds:
            _need_pythonfmu()
        print(f"scene {options.scene} ...", flush=True)
        name, systems, fidelity = load_fidelities(options.scene)
        meta = systems[fidelity].meta
        for kind in kinds:
            able = [p for p in PYTHON_PLATFORMS if p in platforms] if platforms and kind == "python" else platforms
            if able == []:
                print(f"python: left out, it runs on {', '.join(PYTHON_PLATFORMS)} only", flush=True)
                continue
            file = build_fmu(
                systems,
                name,
                options.out,
                able,
                lambda text, kind=kind: print(f"{kind}: {text}", flush=True),
                kind,
                fidelity,
                *(options.author, options.copyright, options.license),
            )
            print(
                f"{file}: {file.stat().st_size / 1e6:.1f} MB, {len(meta['inputs'])} inputs, "
                f"{len(meta['sensors'])} sensors",
                flush=True,
            )
    except (ValueError, RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def _need_pythonfmu() -> None:
    try:
        import pythonfmu  # noqa: F401
    except ImportError:
        raise ValueError(
            'PythonFMU is not installed; run: pip install "ali3[fmu]", or leave out --kind python'
        ) from None


if __name__ == "__main__":
    sys.exit(main())
