"""Makes worlds to drive in: ``ali3 world NAME-or-FILE --out DIR [--picture]``."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from ali3.running import run_command

WORLDS = Path(__file__).parent
ROADS = Path(__file__).parents[1] / "roads" / "files"
_EPILOG = """\
DIR gets NAME.road, what wheels feel (road.file of an FMU), NAME.json, what is drawn and where a car may start, and
with --picture NAME.png, a map. A world is kept and copied when it is asked for again; ALI3_CACHE names the folder.
"""


def main(arguments: Sequence[str] | None = None, prog: str = "python -m mbs.worlds.command") -> int:
    """Run the command, which the user typed as `prog`."""
    parser = argparse.ArgumentParser(
        prog=prog,
        description="Make the road file and the drawing of a world.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "world",
        metavar="NAME-or-FILE",
        help=f"{', '.join(shipped_worlds())}, or a file: .toml of a world (docs/worlds.md) or a road, or .road",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder of the files")
    parser.add_argument("--picture", action="store_true", help="draw a map")
    options = parser.parse_args(arguments)
    return run_command(lambda: _work(options), (ValueError,))


def shipped_worlds() -> list[str]:
    """Names of the worlds and roads of the package."""
    return [path.stem for path in sorted(WORLDS.glob("*.toml"))] + [path.stem for path in sorted(ROADS.glob("*.road"))]


def _work(options: argparse.Namespace) -> int:
    from mbs.worlds.stored import add_file, key_of, world_files

    begin = time.perf_counter()
    file = _file(options.world)
    name = file.stem
    files = [file]
    if file.suffix.lower() == ".toml":
        from mbs.worlds.world_file import named_files

        name, others = named_files(file)
        files += others
    key = key_of(files)
    made, kept = world_files(key, lambda folder: _make(file, name, folder), options.out)
    if options.picture:
        made.append(
            add_file(key, Path(f"{name}.png"), lambda target: _draw(options.out / f"{name}.json", target), options.out)
        )
    for path in made:
        print(f"written: {path} ({path.stat().st_size / 1e6:.3g} MB)")
    print(f"{'kept from before' if kept else 'made'}: {time.perf_counter() - begin:.2f} s")
    return 0


def _file(given: str) -> Path:
    """The file that a name or path means."""
    path = Path(given)
    if path.is_file():
        if path.suffix.lower() not in (".toml", ".road"):
            raise UserError(f"{given} is no world; a .toml of a world or a .road file is one.")
        return path
    for place in (WORLDS / f"{given}.toml", ROADS / f"{given.removesuffix('.road')}.road"):
        if place.is_file() and Path(given).name == given:
            return place
    raise UserError(f"There is no world '{given}' and no such file; worlds are {', '.join(shipped_worlds())}.")


def _make(file: Path, name: str, folder: Path) -> None:
    from mbs.worlds.make_world import make_world

    record: dict[str, Any] = make_world(file, name, folder / f"{name}.road", _Line(name))
    (folder / f"{name}.json").write_text(
        json.dumps(record, allow_nan=False, separators=(",", ":"), ensure_ascii=False), encoding="utf-8"
    )


def _draw(record: Path, target: Path) -> None:
    from mbs.worlds.map_picture import draw_map

    draw_map(json.loads(record.read_text(encoding="utf-8")), target)


class _Line:
    """A line that says what is done, on a terminal over and over, else once a part."""

    def __init__(self, name: str) -> None:
        self.name, self.said, self.part = name, 0.0, ""

    def __call__(self, part: str, share: float) -> None:
        now = time.perf_counter()
        if sys.stderr.isatty():
            if now - self.said > 0.2 or share >= 1.0:
                self.said = now
                end = "\n" if share >= 1.0 else ""
                print(f"\r{self.name}: {part} {100.0 * share:3.0f} %", end=end, file=sys.stderr, flush=True)
        elif part != self.part:
            self.part = part
            print(f"{self.name}: {part} ...", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
