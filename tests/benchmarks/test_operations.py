"""Operations are counted from the instructions that a program executes."""

import platform
from pathlib import Path

import pytest

from benchmarks.car.operations import disassembler, executed
from benchmarks.car.scene_instructions import find_valgrind
from mbs.kernel import build
from tests.unoptimised import unoptimised

PROGRAM = """
#include <math.h>
#include <stdlib.h>
typedef double vector __attribute__((vector_size(32)));
int main(int n_arguments, char **arguments) {
  volatile double x = 3.0;
  volatile vector v = {1.0, 2.0, 3.0, 4.0};
  for (int i = atoi(arguments[n_arguments - 1]); i > 0; i--) {
    x = x * 1.5;
    x = x - 2.0;
    x = x / 3.0;
    v = v + 0.5;
  }
  return x > 9.0;
}
"""


@pytest.mark.slow
@unoptimised()
@pytest.mark.skipif(
    find_valgrind() is None or disassembler() is None or platform.machine() not in ("x86_64", "AMD64"),
    reason="needs valgrind, objdump and their instructions",
)
def test_each_number_of_a_vector_is_an_operation(tmp_path: Path) -> None:
    source, program = tmp_path / "program.c", tmp_path / "program"
    source.write_text(PROGRAM, encoding="utf-8")
    build.compile_c([source], build.host_target(), program, include=(), what="the program", shared=False)
    counts = [executed([str(program), repeats]) for repeats in ("0", "1000")]
    instructions, operations = ((b or 0) - (a or 0) for a, b in zip(*counts, strict=True))
    assert operations == 1000 * (3 + 4)
    assert instructions > 7000
