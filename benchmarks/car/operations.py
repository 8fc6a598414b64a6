"""Floating-point operations that a program executes, counted from its machine code."""

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

from benchmarks.car.scene_instructions import count_instructions

_ARITHMETIC = re.compile(
    r"^\s*([0-9a-f]+):\s+v?(?:add|sub|mul|div|sqrt|min|max|addsub|hadd|(fn?m(?:add|sub)\d{3}))(sd|pd)\s+(\S.*)$", re.M
)


@cache
def disassembler() -> str | None:
    """The program objdump; None if it is not installed."""
    return shutil.which("objdump")


def executed(command: Sequence[str]) -> tuple[int | None, int | None]:
    """Instructions of a program and floating-point operations; None without valgrind.

    Operations are sums, differences, products, quotients, square roots and extrema of doubles, one for each number of a
    vector, including operations of the C library. They are None without objdump and 0 on other processors than x86-64.
    """
    if disassembler() is None:
        return count_instructions(command), None
    with tempfile.TemporaryDirectory() as folder:
        profile = Path(folder, "profile")
        total = count_instructions(command, profile, ("--dump-instr=yes", "--compress-pos=no", "--compress-strings=no"))
        if total is None:
            return None, None
        executions = _executions(profile.read_text(encoding="utf-8"))
        return total, sum(count * _numbers(binary).get(address, 0) for binary, address, count in executions)


def _executions(profile: str) -> Iterator[tuple[str, int, int]]:
    """Binary, address and number of executions of each instruction in a profile of callgrind."""
    binary, inclusive = "", False
    for line in profile.splitlines():
        if line.startswith("ob="):
            binary = line[3:]
        elif line.startswith("calls="):
            inclusive = True  # the next line has the cost of the called function
        elif line.startswith("0x"):
            if not inclusive:
                address, _, count = line.split()
                yield binary, int(address, 16), int(count)
            inclusive = False


@cache
def _numbers(binary: str) -> dict[int, int]:
    """Operations of each arithmetic instruction of a binary by its address."""
    if not Path(binary).is_file():
        return {}
    command = [str(disassembler()), "-d", "--no-show-raw-insn", binary]
    code = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return {
        int(address, 16): (2 if fused else 1) * (1 if kind == "sd" else _width(operands))
        for address, fused, kind, operands in _ARITHMETIC.findall(code)
    }


def _width(operands: str) -> int:
    """Doubles in the vectors of an instruction."""
    return 8 if "%zmm" in operands else 4 if "%ymm" in operands else 2
