"""Numbers with units on the command line, and misspelt options."""

import argparse
import math
from pathlib import Path

import pytest

from ali3.options import Parser, add_option
from ali3.units import number_with_unit, quantity
from hosts.common.errors import HostError
from hosts.common.package_names import check_car, check_world
from hosts.fmu.variables import Variable
from hosts.recordings.load_manoeuvre import check_manoeuvre_option


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("20kN/m", "N/m", 20e3),
        ("2.5kN.s/m", "N.s/m", 2500.0),
        ("2500 N*s / m", "N.s/m", 2500.0),
        ("5 kg m^2", "kg.m2", 5.0),
        ("20 N mm", "N.m", 0.02),
        ("10ms", "s", 0.01),
        ("100mph", "m/s", 44.704),
        ("-45deg", "rad", -math.pi / 4.0),
        ("30%", "1", 0.3),
        ("20degC", "K", 293.15),
        ("1e3", "N", 1000.0),
        ("7", "", 7.0),
    ],
)
def test_a_number_may_have_a_unit_of_its_quantity(text, unit, value):
    assert number_with_unit(text, unit) == pytest.approx(value)


@pytest.mark.parametrize(
    ("text", "unit", "message"),
    [
        ("20kN", "N/m", "'20kN' is not a number; write one in N/m, or with a unit .* behind it, such as 20N/m"),
        ("3m", "1", "'3m' is not a number; write one without a unit, such as 3$"),
        ("3ms", "", "'3ms' is not a number; write it without a unit, such as 3$"),
        ("abc", "s", "'abc' is not a number$"),
        ("nan", "s", "the value is nan"),
    ],
)
def test_another_unit_is_reported_with_how_it_is_written(text, unit, message):
    with pytest.raises(ValueError, match=message):
        number_with_unit(text, unit)


def test_only_the_command_line_takes_units():
    stiffness = Variable("k", "", "parameter", "tunable", "Real", "N/m", 1.0, 0.0, 5e4, None, {}, {})
    assert stiffness.read("20kN/m", "--set", with_unit=True) == 20e3
    with pytest.raises(HostError, match="a table: 'k': '20kN/m' is not a number"):
        stiffness.read("20kN/m", "a table")
    with pytest.raises(HostError, match=r"--set: 'k' is 6e\+04 N/m|'k' is 60000 N/m"):
        stiffness.read("60kN/m", "--set", with_unit=True)
    assert quantity("s")("inf") == math.inf
    with pytest.raises(argparse.ArgumentTypeError, match="write one in s"):
        quantity("s")("10mm")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (["-manoeuvre", "slalom"], "unrecognized arguments: -manoeuvre; did you mean '--manoeuvre'?"),
        (["--maneuver", "slalom"], "unrecognized arguments: --maneuver slalom; did you mean '--manoeuvre'?"),
        (["--colour"], "unrecognized arguments: --colour\n"),
        (["--step", "10mm"], "argument --step: '10mm' is not a number; write one in s"),
    ],
)
def test_a_misspelt_option_is_reported_with_the_near_one(line, message, capsys):
    parser = Parser(prog="p")
    for name in ("--manoeuvre", "--step"):
        add_option(parser, name)
    with pytest.raises(SystemExit):
        parser.parse_args(line)
    assert message in capsys.readouterr().err


def test_options_of_one_letter_and_their_values_are_unchanged():
    parser = Parser(prog="p")
    for name in ("--manoeuvre", "--step"):
        add_option(parser, name)
    parser.add_argument("rest", nargs="*")
    actual = parser.parse_args(["-mslalom", "--step", "10ms", "--", "-manoeuvre"])
    assert (actual.manoeuvre, actual.step, actual.rest) == ("slalom", 0.01, ["-manoeuvre"])


def test_a_value_may_begin_with_a_minus_sign():
    parser = Parser(prog="p")
    parser.add_argument("--travel", type=quantity("mm"), nargs=2)
    parser.add_argument("--between")
    actual = parser.parse_args(["--travel", "-3cm", "-1e1", "--between", "-1:1"])
    assert (actual.travel, actual.between) == ([-30.0, -10.0], "-1:1")


def test_misspelt_cars_worlds_and_manoeuvres_are_reported_before_anything_is_made(tmp_path):
    for check, word, meant in (
        (lambda word: check_car(Path(word)), "hatchbak", "hatchback"),
        (check_world, "proving_grund", "proving_ground"),
        (check_manoeuvre_option, "slalm", "slalom"),
    ):
        with pytest.raises(HostError, match=f"There is no .* '{word}'.*; did you mean '{meant}'"):
            check(word)
        check(meant)
    with pytest.raises(HostError, match="the cars of the package are .*, prototype, saloon"):
        check_car(Path("xyz"))
    check_car(tmp_path)
    check_manoeuvre_option(None)


def test_abbreviations_of_options_are_refused(capsys):
    """Reports that repeat a command look for whole options."""
    parser = Parser(prog="p")
    parser.add_argument("--test-setting")
    with pytest.raises(SystemExit):
        parser.parse_args(["--test-set", "a.b=1"])
    assert "did you mean '--test-setting'?" in capsys.readouterr().err
