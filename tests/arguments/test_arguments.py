"""Every argument of the public functions and elements, given wrong values: each is refused in a sentence of ours that
names what is wrong, and nothing has changed.
"""

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest

from mbs import Model
from tests.arguments import elements, flexible, model, simulation
from tests.arguments.wrong_values import as_scalars, kinds_of, problems_of

CALLS = {
    f"{table.__name__.rpartition('.')[2]}: {name}": call
    for table in (elements, flexible, model, simulation)
    for name, call in table.CALLS.items()
}


def called(function: Callable[..., object], right: dict[str, Any], argument: str, value: Any) -> None:
    """Call a function with another value of an argument."""
    function(**(right | {argument: value}))


@pytest.mark.parametrize("name", CALLS)
def test_the_right_values_pass(name):
    """Also with numbers of NumPy."""
    function, right = CALLS[name].make()
    function(**right)
    for k in range(3):
        function, right = CALLS[name].make()
        function(**{argument: as_scalars(value)[k] for argument, value in right.items()})


@pytest.mark.parametrize("name", CALLS)
def test_wrong_values_are_refused_and_change_nothing(name):
    call, problems = CALLS[name], []
    for argument in call.kinds:
        function, right = call.make()
        before = call.state(function)
        problems += problems_of(partial(called, function, right, argument), argument, partial(call.standing, argument))
        if call.state(function) != before:  # of all values together: it takes longer than they do
            problems.append(f"{argument}: a value that was refused has changed what was there")
    assert not problems, "\n".join(problems)


def test_every_method_of_a_model_is_in_the_table():
    methods = {name for name, _ in inspect.getmembers(Model, inspect.isfunction) if not name.startswith("_")}
    assert methods - model.REGISTER == {model.method_of(call) for call in model.RIGHT}


def test_every_argument_of_a_model_is_in_the_table():
    arguments: dict[str, set[str]] = {}
    for call, right in model.RIGHT.items():
        arguments.setdefault(model.method_of(call), set()).update(right(model.Bench()))
    assert arguments == {method: set(kinds_of(getattr(Model, method))) for method in arguments}
