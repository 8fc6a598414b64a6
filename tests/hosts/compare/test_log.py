"""Logs as data loggers write them: delimiters, decimals, units, clocks, several rates."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hosts.common.errors import HostError
from hosts.common.units import unit_definition
from hosts.compare.log import Log, log_for
from hosts.compare.log_aliases import Dialect, LogAliases, read_log_aliases
from hosts.compare.log_file import read_log
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import Fmu
from hosts.fmu.named_fmu import NamedFmu

ROWS = 40


@pytest.fixture(scope="module")
def fmu(tuned: Path) -> Iterator[NamedFmu]:
    with Fmu(tuned) as opened:
        yield NamedFmu(opened, Aliases())


def read(fmu: NamedFmu, folder: Path, text: str, aliases: str = "", encoding: str = "utf-8") -> Log:
    (folder / "log.csv").write_text(text, encoding=encoding)
    (folder / "log.toml").write_text(aliases, encoding="utf-8")
    named = read_log_aliases(folder / "log.toml") if aliases else LogAliases()
    return log_for(fmu, read_log(folder / "log.csv", named.dialect), named)


def rows(form: str) -> str:
    return "\n".join(form.format(t=0.01 * k, ms=10 * k, f=0.5 * k, x=0.001 * k) for k in range(ROWS)) + "\n"


def assert_read(log: Log) -> None:
    assert log.inputs["pull"].values == pytest.approx(0.5 * np.arange(ROWS))
    assert log.outputs["bob.x"].values == pytest.approx(0.001 * np.arange(ROWS))
    assert log.outputs["bob.x"].time == pytest.approx(0.01 * np.arange(ROWS))


@pytest.mark.parametrize(("used", "reported"), [(("bob.x",), 1), (("speed",), 0)])
def test_an_omitted_sample_is_reported_for_used_signals(fmu, tmp_path, used, reported):
    text = "time,pull,bob.x\n" + rows("{t},{f},{x}").replace("0.12,6.0,0.012", "0.12,6.0,9.9")
    (tmp_path / "log.csv").write_text(text)
    log = log_for(fmu, read_log(tmp_path / "log.csv", LogAliases().dialect), LogAliases(), noted=used)
    assert len(log.outputs["bob.x"].values) == ROWS - 1
    assert sum("no neighbour supports" in note for note in log.notes) == reported


@pytest.mark.parametrize("second", [0.5 * 12, 30.0])
def test_an_input_jumps_between_two_rows_of_one_time(fmu, tmp_path, second):
    """An output has the first of them; the same value twice is no jump, and one that is not a spike."""
    text = "time,pull,bob.x\n" + rows("{t},{f},{x}").replace("0.12,6.0,0.012\n", f"0.12,6.0,0.012\n0.12,{second},0.5\n")
    log = read(fmu, tmp_path, text)
    jumps = second == 30.0
    assert len([note for note in log.notes if "1 of pull, the first at 0.12 s." in note]) == jumps
    assert log.outputs["bob.x"].values == pytest.approx(0.001 * np.arange(ROWS))
    usual = 0.5 * np.arange(ROWS)
    assert log.inputs["pull"].values == pytest.approx(np.insert(usual, 13, 30.0) if jumps else usual)
    assert log.inputs["pull"].jumps.tolist() == pytest.approx([0.12] if jumps else [])
    assert log.inputs["pull"].interval == pytest.approx(0.01)


def test_times_of_a_clock_and_over_midnight(fmu, tmp_path):
    begin, text = 86399.95, "time,pull,bob.x\n"
    for k in range(ROWS):
        t = (begin + 0.01 * k) % 86400.0
        text += f"{int(t // 3600):02d}:{int(t // 60) % 60:02d}:{t % 60:06.3f},{0.5 * k},{0.001 * k}\n"
    assert_read(read(fmu, tmp_path, text))
    short = "".join(f"07:{0.01 * k:06.3f},{0.5 * k},{0.001 * k}\n" for k in range(ROWS))
    assert_read(read(fmu, tmp_path, "time,pull,bob.x\n" + short))
    with pytest.raises(HostError, match=r"line 4, column 'time': the time '7 h' is not written as 07:00\.000\.$"):
        read(fmu, tmp_path, "time,pull,bob.x\n" + short.replace("07:00.020", "7 h"))


def test_a_heading_that_is_repeated_is_reported_by_its_line(fmu, tmp_path):
    """Empty lines are counted; a word among numbers is told as what it is."""
    heading = "time [ms],pull,bob.x\n"
    lines = (heading + rows("{ms},{f},{x}")).splitlines()
    again = [*lines[:4], "", heading.strip(), *lines[4:]]
    with pytest.raises(HostError, match=r"log\.csv, line 6: the heading occurs again; split the log there"):
        read(fmu, tmp_path, "\n".join(again))
    again[5] = "time [ms],pull,"  # cut behind a cell that is empty
    with pytest.raises(HostError, match=r"log\.csv, line 6, column"):
        read(fmu, tmp_path, "\n".join(again))
    again[5] = "soon,1,2"
    with pytest.raises(HostError, match=r"line 6, column 'time': the time 'soon' is not a number"):
        read(fmu, tmp_path, "\n".join(again))
    again[5] = lines[3].rpartition(",")[0] + ",far"
    with pytest.raises(HostError, match=r"line 6, column 'bob\.x': 'far' is not a number"):
        read(fmu, tmp_path, "\n".join(again))


@pytest.mark.parametrize("form", ["{t} s,{f} N,{x} m", "{t}s;{f}N;{x}m", "{t},{f} N,{x} m"])
def test_units_behind_numbers_are_reported(fmu, tmp_path, form):
    mark = ";" if ";" in form else ","
    text = mark.join(("time", "pull", "bob.x")) + "\n" + rows(form)
    with pytest.raises(HostError, match=r"line 2.*: '0\.0 ?[sN]' has a unit after the number; .* 'name \[[sN]\]'"):
        read(fmu, tmp_path, text)


def test_german_logger(fmu, tmp_path):
    text = rows("{ms};{f};{x}").replace(".", ",")
    text = text.replace("\n", ";\n")  # many loggers end a row with a delimiter
    aliases = '[time]\nname = "Zeit"\nunit = "ms"\n[signals]\npull = { name = "Kräft" }\n"bob.x" = { name = "Weg" }'
    heading = "Prüfstand 3;;;\nZeit;Kräft;Weg;\n[ms];[N];[m];\n"
    assert_read(read(fmu, tmp_path, heading + text, aliases, "latin-1"))


def test_units_of_the_heading_and_of_the_aliases(fmu, tmp_path):
    text = "t [ms]\tF [kN]\tx\n" + rows("{ms}\t{f}\t{x}")
    log = read(fmu, tmp_path, text, '[signals]\npull = "F"\n"bob.x" = { name = "x", unit = "mm" }')
    assert log.inputs["pull"].values == pytest.approx(500.0 * np.arange(ROWS))
    assert log.outputs["bob.x"].values == pytest.approx(1e-6 * np.arange(ROWS))
    assert log.outputs["bob.x"].time[-1] == pytest.approx(0.01 * (ROWS - 1))


def test_the_line_of_units_may_stand_above_that_of_the_names(fmu, tmp_path):
    log = read(fmu, tmp_path, "ms,kN,m\ntime,pull,bob.x\n" + rows("{ms},{f},{x}"), "[file]\nunits = 1")
    assert log.inputs["pull"].values == pytest.approx(500.0 * np.arange(ROWS))


@pytest.mark.parametrize("head", ["# time,pull,bob.x\n# s,kN,m\n", "time,pull,bob.x\n#s,kN,m\n"])
def test_names_and_units_may_be_comments(fmu, tmp_path, head):
    log = read(fmu, tmp_path, head + rows("{t},{f},{x}"))
    assert log.inputs["pull"].values == pytest.approx(500.0 * np.arange(ROWS))
    remark = read(fmu, tmp_path, "#by,A.,Smith\ntime,pull,bob.x\n" + rows("{t},{f},{x}"))
    assert remark.inputs["pull"].values == pytest.approx(0.5 * np.arange(ROWS))


def test_factor_and_offset_are_those_of_other_alias_files(fmu, tmp_path):
    """The number in the log is factor * ours + offset, as in the alias file of an FMU."""
    log = read(
        fmu,
        tmp_path,
        "time,pull,bob.x\n" + rows("{t},{f},{x}"),
        '[signals]\n"bob.x" = { name = "bob.x", unit = "cm", factor = -2.0, offset = 1.0 }',
    )
    assert log.outputs["bob.x"].values == pytest.approx((0.001 * np.arange(ROWS) - 1.0) / -2.0 / 100.0)


def test_clock_with_factor_offset_and_its_own_column(fmu, tmp_path):
    text = "clock,imu,pull,bob.x\n" + rows("{ms},{t},{f},{x}")
    aliases = (
        '[time]\nname = "clock"\nunit = "s"\nfactor = 1000.0\noffset = -50.0\n'
        '[signals]\npull = "pull"\n"bob.x" = "bob.x"'
    )
    assert_read(read(fmu, tmp_path, text, aliases))


@pytest.mark.parametrize("unit", ["epoch_ms", "iso"])
def test_moments(fmu, tmp_path, unit):
    moments = pd.Timestamp("2024-05-03T12:00:00") + pd.to_timedelta(10.0 * np.arange(ROWS), unit="ms")
    texts = [str(int(m.timestamp() * 1000)) if unit == "epoch_ms" else m.isoformat() for m in moments]
    lines = [f"{t},{0.5 * k},{0.001 * k}" for k, t in enumerate(texts)]
    text = "time,pull,bob.x\n" + "\n".join(lines) + "\n"
    assert_read(read(fmu, tmp_path, text, f'[time]\nname = "time"\nunit = "{unit}"\n[signals]\npull = "pull"'))


def test_several_rates_leave_cells_empty(fmu, tmp_path):
    lines = [f"{0.01 * k:.2f},{0.5 * k},{0.001 * k if k % 4 == 0 else ''}" for k in range(ROWS)]
    log = read(fmu, tmp_path, "time,pull,bob.x\n" + "\n".join(lines) + "\n")
    assert log.outputs["bob.x"].interval == pytest.approx(0.04)
    assert log.inputs["pull"].interval == pytest.approx(0.01)
    assert len(log.outputs["bob.x"].values) == ROWS // 4


@pytest.mark.parametrize(
    ("unit", "si"),
    [
        ("km/h", 1.0 / 3.6),
        ("deg", math.pi / 180.0),
        ("°/s", math.pi / 180.0),
        ("g", 9.80665),
        ("m/s^2", 1.0),
        ("[m/s²]", 1.0),
        ("1/min", math.pi / 30.0),
        ("bar", 1e5),
        ("%", 0.01),
        ("Nm", 1.0),
        ("mph", 1609.344 / 3600.0),
        ("psi", 6894.757293168),
        ("lbf.ft", 1.3558179483314),
    ],
)
def test_units(unit, si):
    assert unit_definition(unit, "").factor == pytest.approx(si, rel=1e-12)


SUMMER_ENDS = "2024-10-27T01:59:59.800+00:00"


def stamped(form: str, shift: float = 0.0) -> str:
    """Rows with stamps of ISO 8601; `shift`: from row 20 on, s."""
    begin = pd.Timestamp(SUMMER_ENDS)
    stamps = [begin + pd.Timedelta(seconds=0.01 * k + shift * (k >= 20)) for k in range(ROWS)]
    return "".join(
        form.format(stamp.isoformat(timespec="milliseconds"), 0.001 * k) + "\n" for k, stamp in enumerate(stamps)
    )


def test_stamps_with_a_decimal_comma_and_of_two_zones(fmu, tmp_path):
    alias = '[signals]\n"bob.x" = "x"\n[time]\nname = "stamp"'
    with_comma = "stamp;x\n" + stamped("{0};{1}").replace("+00:00", "").replace(".", ",").replace("T", " ")
    lines = stamped("{0};{1}").splitlines()
    lines[20:] = [line.replace("T02:", "T03:").replace("+00:00", "+01:00") for line in lines[20:]]
    for text in (with_comma, "\n".join(["stamp;x", *lines, ""])):
        actual = read(fmu, tmp_path, text, alias).outputs["bob.x"]
        assert actual.time == pytest.approx(0.01 * np.arange(ROWS))
        assert actual.values == pytest.approx(0.001 * np.arange(ROWS))


@pytest.mark.parametrize(("rate", "jitter"), [(10, 1), (5, 0)])
def test_a_signal_that_is_repeated_row_by_row_counts_where_it_is_new(fmu, tmp_path, rate, jitter):
    count, chance = 20 * rate, np.random.default_rng(3)
    new = np.clip(rate * np.arange(20) + chance.integers(-jitter, jitter + 1, 20), 0, None)
    new[0] = 0
    staircase = np.sin(new)[np.searchsorted(new, np.arange(count), side="right") - 1]
    lines = [f"{0.01 * k:.2f},{0.5 * k},{float(staircase[k])!r},{0.25 * (k // rate)}" for k in range(count)]
    log = read(fmu, tmp_path, "time,pull,bob.x,bob.y\n" + "\n".join(lines) + "\n")
    actual = log.outputs["bob.x"]
    assert actual.time == pytest.approx(0.01 * new)
    assert actual.values == pytest.approx(np.sin(new))
    (repeated,) = [note for note in log.notes if "has a new value every" in note]
    assert f"every {rate} rows" in repeated
    assert len(log.outputs["bob.y"].time) == count  # a ramp of a coarse signal


BAD = [
    ("time,pull,bob.x\n" + rows("{t},{f},{x}").replace("0.2,", "0.05,", 1), "", "goes back from 0.19 s to 0.05 s"),
    ("\n".join(["time,pull,bob.x", *rows("{t},{f},{x}").splitlines()[::-1]]), "", "the rows run backwards in time"),
    ("time,pull,bob.x\n" + rows("{t},{f},{x}").replace("0.2,", "0.18,", 1), "", "sort them"),
    ("stamp;bob.x\n" + stamped("{0};{1}", -3600.0), '[time]\nname = "stamp"', "set back by an hour"),
    (
        "stamp;bob.x\n" + stamped("{0};{1}").replace("2024-10-27T", "27.10.2024 "),
        '[time]\nname = "stamp"',
        "a date such as 2024",
    ),
    ("time,pull,bob.x\n" + rows("{t},{f},{x}").replace("0.011\n", "invalid\n"), "", "a cell without one is empty"),
    ("time,pull,bob.x\n" + rows("{ms},{f},{x}"), "", '[time] unit = "ms"'),
    ("time,Pull,bob_x\n" + rows("{t},{f},{x}"), "", "has no column with the name of an input or output"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\npull = "f"', "has no column 'f'; did you mean 'F'"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\n"bob.X" = "x"', "'bob.X' is not an input or output of Tuned"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\n"spring.free_length" = "x"', "is a parameter of Tuned.fmu"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\npull = { name = "F", unit = "deg" }', "is in 'deg'; 'pull' of"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\npull = { name = "F", unit = "kNn" }', "or 'kN'"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[signals]\npull = { nam = "F" }', "must be a column of the log"),
    ("time,F,x\n" + rows("{t},{f},{x}"), '[time]\nunit = "hours"', "time.unit is 'hours'; it must be one of s, ms"),
    ("time,F,x\n" + rows("{t},{f},{x}"), "[sensors]\na = 'x'", "keys of the file are file, time, signals"),
    ("a,pull,bob.x\n" + rows("{t},{f},{x}"), "", "has no column of times"),
    ("time,pull,bob.x\n0,1,2\n0.1,2,3\n", "", "at least 10 are needed"),
    ("time pull bob.x\n" + rows("{t} {f} {x}"), "", "is not a table of numbers"),
    ('"time [s]",pull,bob.x[1]\n', "", "has no line that begins with a number; below its names it needs rows."),
    (rows("{t},{f},{x}"), "", "has no line of 3 names"),
    ("time,F,x\n" + rows("{t},{f},{x}"), "[file]\nheading = 1\nunits = 1", "heading and units are both 1"),
    ("time,F,x\n" + rows("{t},{f},{x}"), "[file]\nencoding = 'punycode'", "is not written in punycode"),
]


@pytest.mark.parametrize(("text", "aliases", "message"), BAD)
def test_bad_logs_are_reported_in_a_sentence(fmu, tmp_path, text, aliases, message):
    with pytest.raises(HostError) as refusal:
        read(fmu, tmp_path, text, aliases)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("cut", ["0.4,20.0,0.0", "0.4,20.0", "0."])
def test_a_row_without_a_line_end_is_left_out_and_reported(fmu, tmp_path, cut):
    """Of 0.04 a cut log has left 0.0, which nothing tells from a whole number."""
    log = read(fmu, tmp_path, "time,pull,bob.x\n" + rows("{t},{f},{x}") + cut)
    assert_read(log)
    assert "The last line has no line end, as where a log was cut: its row is left out." in log.notes
    assert read(fmu, tmp_path, "time,pull,bob.x\n" + rows("{t},{f},{x}")).notes == []


def test_what_pandas_has_written_besides_does_not_matter(tmp_path):
    """The index is a column; of damaged notes of pandas nothing is read."""
    frame = pd.DataFrame({"u": [1.0, 2.0]}, index=pd.Index([0.0, 0.1], name="t"))
    table = pa.Table.from_pandas(frame)
    for notes in (table.schema.metadata, {b"pandas": b'{"index_columns": ["lost"], "columns": 3}'}, {b"pandas": b"{"}):
        pq.write_table(table.replace_schema_metadata(notes), tmp_path / "a.parquet")
        log = read_log(tmp_path / "a.parquet", Dialect())
        assert log.numbers("u").tolist() == [1.0, 2.0]
        assert log.numbers("t").tolist() == [0.0, 0.1]
    pq.write_table(pa.Table.from_pandas(pd.DataFrame({"u": [1.0]}, index=[7])), tmp_path / "b.parquet")
    assert list(read_log(tmp_path / "b.parquet", Dialect()).table) == ["u"]


def test_what_squares_to_no_number_is_refused_with_its_line(fmu, tmp_path):
    text = "time,pull,bob.x\n" + rows("{t},{f},{x}")
    read(fmu, tmp_path, text.replace("0.12,6.0", "0.12,9e99"))
    with pytest.raises(HostError, match=r"line 14, column 'pull': -2e\+100 is too large; numbers up to 1e\+100"):
        read(fmu, tmp_path, text.replace("0.12,6.0", "0.12,-2e100"))


def test_a_file_of_another_kind(tmp_path):
    for name, content, message in (
        ("a.mf4", b"MDF     4.10", "asammdf"),
        ("a.parquet", b"PAR1 no", "is not a Parquet file"),
        ("a.csv", b"\x00\x01\x02", "is not text"),
        ("b.csv", None, "there is no such file"),
    ):
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(HostError, match=message):
            read_log(tmp_path / name, LogAliases().dialect)
