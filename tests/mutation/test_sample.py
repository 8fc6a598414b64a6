"""Mutants drawn by chance: their operators, the same for the same seed, found again where code has moved."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from tests.mutation.choice import batches_of
from tests.mutation.command import STORED, read
from tests.mutation.operators import changes
from tests.mutation.sample import Sampled, draw, squeeze
from tests.mutation.table import ROOT

PYTHON = '''def area(of, *, per=1.5):
    """A text of 2 words, not mutated - at all."""
    if of in SEEN and not abs(-of.width) < 2:
        SEEN.add(of, per)
    return table[0, of]
'''
SHIFTED = """class Shape:
    def area(self, of):
        if of in SEEN and not abs(
            -of.width
        ) < 2:
            SEEN.add(of, 1.5)
"""


def texts(source: str, suffix: str) -> list[tuple[str, str]]:
    """Operators and changed texts, without spaces."""
    data = source.encode()
    mutants = [(c.operator, (data[: c.start] + c.new.encode() + data[c.end :]).decode()) for c in changes(data, suffix)]
    return [(operator, squeeze(text)) for operator, text in mutants]


@pytest.mark.parametrize(
    ("suffix", "source", "operator", "expected"),
    [
        (".py", "x = a + b", "arithmetic", ["x = a - b"]),
        (".py", "a < b <= c", "comparison", ["a <= b <= c", "a > b <= c", "a < b < c", "a < b >= c"]),
        (".py", "x = a and not b", "boolean", ["x = a or not b"]),
        (".py", "x = a and not b", "not", ["x = a and b"]),
        (".py", "x: Literal[1] = f(0, 1, 0.0, -3e-4)", "sign", ["x: Literal[1] = f(0, 1, 0.0, 3e-4)"]),
        (".py", "@f(True)\ndef g(a=False): pass", "truth", ["@f(True)\ndef g(a=True): pass"]),
        (".py", "def f(): return x", "returned value", ["def f(): return None"]),
        (".py", "a[i, j] = f(x, y, key=z)", "order", ["a[j, i] = f(x, y, key=z)", "a[i, j] = f(y, x, key=z)"]),
        (".c", "int f(void) { in->a = b; return 7; }", "removed statement", ["int f(void) { {} return 7; }"]),
        (".c", "int f(void) { return ALI3_OK; }", "returned value", []),
        (".c", "int x = !a || *b == 0;", "not", ["int x = a || *b == 0;"]),
        (".js", "const f = () => a === b && c;", "comparison", ["const f = () => a !== b && c;"]),
        (".js", "f(x, y);", "order", ["f(y, x);"]),
        (".js", "const x = { a: true, b: `${1 + 1}` };", "truth", ["const x = { a: false, b: `${1 + 1}` };"]),
    ],
)
def test_an_operator_changes_this_and_nothing_else(suffix, source, operator, expected) -> None:
    assert [text for kind, text in texts(source, suffix) if kind == operator] == [squeeze(text) for text in expected]


def test_constants_change_by_one_or_by_a_factor() -> None:
    result = [float(text.removeprefix("x=")) for _, text in texts("x = 1", ".py")]
    assert result == [2.0, 0.0]
    assert texts("x = 0.0", ".py") == [("constant", "x=1.0")]
    ((_, text),) = texts("double x = 3e-4;", ".c")
    assert 1.005 < float(text.removeprefix("doublex=").removesuffix(";")) / 3e-4 < 2.1


@pytest.mark.slow
def test_a_seed_draws_the_same_from_all_rooms() -> None:
    drawn = [[next(stream) for stream in draw(24, seed)] for seed in (7, 7, 8)]
    assert drawn[0] == drawn[1]
    assert len(set(drawn[0])) == 24 > 2 * len(set(drawn[0]) & set(drawn[2]))
    assert {Path(m.file).suffix for m in drawn[0]} >= {".py", ".c", ".js"}
    assert {Path(m.file).parts[0] for m in drawn[0]} >= {"mbs", "hosts", "viewer", "fmu_src", "benchmarks"}
    for mutant in drawn[0]:
        path, content = mutant.apply()
        assert path == ROOT / mutant.file
        assert content != path.read_text(encoding="utf-8")
        assert any(name.endswith((".py", ".js")) for name in batches_of(mutant, ROOT)[0])


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in ("mbs/room/area.py", "mbs/room/other.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / "mbs/room/area.py").write_text(PYTHON, encoding="utf-8")
    (tmp_path / "mbs/room/other.py").write_text("def volume(of):\n    return table[0, of]\n", encoding="utf-8")
    return tmp_path


def mutants_in(tree: Path, operator: str) -> list[Sampled]:
    """All of an operator in the file that is moved."""
    many = [mutant for stream in draw(4, 1, tree) for mutant in stream]
    assert len(many) == len(set(many))
    return sorted((m for m in many if m.operator == operator and m.file.endswith("area.py")), key=str)


@pytest.mark.slow
def test_a_mutant_is_found_where_its_file_was_moved_and_its_lines_wrapped(tree: Path) -> None:
    comparison = mutants_in(tree, "comparison")
    (swapped,) = (m for m in mutants_in(tree, "order") if "add" in m.line)
    assert len(comparison) == 3  # in, < and its flip
    (tree / "mbs/room/area.py").unlink()
    (tree / "viewer").mkdir()
    (tree / "viewer/shape.py").write_text(SHIFTED, encoding="utf-8")
    actual = [mutant.apply(tree) for mutant in comparison]
    assert {path for path, _ in actual} == {tree / "viewer/shape.py"}
    expected = [SHIFTED.replace(*pair) for pair in ((" in ", " not in "), (") < 2", ") <= 2"), ("< 2", "> 2"))]
    assert sorted(content for _, content in actual) == sorted(expected)
    with pytest.raises(ValueError, match=r"gone, look at it by hand: .*SEEN\.add\(of, per\).*no longer in the code"):
        swapped.apply(tree)


def test_a_line_that_stands_twice_is_distinguished_by_its_function_or_reported(tree: Path) -> None:
    (mutant,) = (m for m in mutants_in(tree, "order") if m.line.strip().startswith("return"))
    assert mutant.apply(tree)[0] == tree / "mbs/room/area.py"
    moved = replace(mutant, file="mbs/room/gone.py")
    assert moved.apply(tree)[0] == tree / "mbs/room/area.py"
    shutil.copy(tree / "mbs/room/area.py", tree / "mbs/room/again.py")
    with pytest.raises(ValueError, match="fits 2 places alike"):
        moved.apply(tree)
    elsewhere = replace(moved, function="weight", before="", after="x")
    with pytest.raises(ValueError, match="gone, look at it by hand"):
        elsewhere.apply(tree)


@pytest.mark.slow
def test_every_stored_mutant_is_in_the_code() -> None:
    gone = []
    for mutant in read(STORED):
        try:
            mutant.apply()
        except ValueError as error:
            gone.append(str(error))
    assert not gone, "\n".join([*gone, f"write the same error into the new text in {STORED.name}, or remove its entry"])
