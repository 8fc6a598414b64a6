"""The loader against damaged and hostile files: a clear refusal, never a crash or a silent acceptance of nonsense."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbs import Model, compile
from mbs.kernel import binding
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import SensorType, SolverValue
from mbs.kernel.read_headers import SensorEntry, sensor_types
from mbs.scenes import bricard, prototype_car
from mbs.settings.settings import METHODS
from mbs.vehicle import load
from tests.methods.models import hinge

from .scenes import everything, four_bar, sleigh
from .system_builder import INTS, REALS, SystemBuilder, pack, seal

SEED = 20240117
Builder = Callable[[], SystemBuilder]
BUILDERS = pytest.mark.parametrize("builder", [everything, sleigh])


def refused(data: bytes) -> str:
    with pytest.raises(KernelError) as refusal:
        LoadedSystem(data)
    assert refusal.value.status == binding.Status.BAD_FILE
    assert refusal.value.message.startswith("the System file was refused: ")
    return refusal.value.message


def exercise(data: bytes) -> bool:
    """Loads, steps and reads what loads; True if it was accepted."""
    try:
        instance = Instance(LoadedSystem(data))
    except KernelError as refusal:
        if refusal.status not in (binding.Status.BAD_FILE, binding.Status.BAD_ARGUMENT, binding.Status.NO_MEMORY):
            raise
        return False
    try:
        instance.initialise(0.0)
        for _ in range(2):
            instance.step(0.01)
        assert np.isfinite(np.array(instance.get_state()[0])).all()
        instance.sensors()
    except KernelError:
        pass
    return True


GOOD = dict.fromkeys("sSeougGrdbkqhnN", 0) | {"S": -1, "G": -1, "T": -1, "n": 2, "N": 2, "P": 3}
"""An integer that each letter of the list of sensor types allows."""
LIMITS = {"s": "nsig", "S": "nsig", "e": "ne", "u": "nu", "g": "ng", "G": "ng", "T": "ng", "r": "nc"}
ORDERS = {"d": 3, "b": 2, "k": 4, "q": 4, "P": 4, "h": len(SolverValue)}
LEAST = {"S": -1, "G": -1, "T": -1, "N": 1, "P": 2}
REALS_OF = {"REACTION": 2, "REACTION_PRODUCTS": 2, "REACTION_BY_TABLE": 2, "QUASI_STATIC": 21}
SCALED = (
    "SIGNAL",
    "SIGNAL_RATE",
    "SIGNAL_SECOND_RATE",
    "ANGULAR_RATE",
    "ELEMENT_OUTPUT",
    "DRIVING",
    "MASS",
    "DRIVING_EXCESS",
    "SCALED_INPUT",
)


def letters_of(entry: SensorEntry) -> str:
    """A letter for each integer of a sensor with the good numbers of items."""
    head, _, items = entry.integers.partition("(")
    count = next((GOOD[letter] for letter in head if letter in "nNP"), 0)
    return head + items.rstrip(")") * count


@pytest.mark.parametrize("entry", sensor_types(), ids=lambda entry: entry.name)
def test_integers_and_reals_of_each_sensor_type_are_checked(entry: SensorEntry) -> None:
    builder, letters = everything(), letters_of(entry)
    sizes = LoadedSystem(builder.to_bytes()).sizes
    good = [GOOD[letter] for letter in letters]
    reals = [1.0] * REALS_OF.get(entry.name, int(entry.name in SCALED))

    def with_sensor(integers: list[int], reals: list[float]) -> bytes:
        builder.sensors[-1] = (entry.number, integers, reals)
        return builder.to_bytes()

    Instance(LoadedSystem(with_sensor(good, reals)))
    for wrong in ([*good, 0], *([good[:-1]] if good else [])):
        assert "sen" in refused(with_sensor(wrong, reals))
    for n in {len(reals) + 1, max(len(reals) - 1, 0)} - {len(reals)}:
        assert f"sensor 6 of type {entry.number} has {n} reals" in refused(with_sensor(good, [1.0] * n))
    for k, letter in enumerate(letters):
        too_small = LEAST.get(letter, 0) - 1
        too_large = (
            [getattr(sizes, LIMITS[letter])] if letter in LIMITS else [ORDERS[letter]] if letter in ORDERS else []
        )
        for wrong_value in (too_small, *too_large):
            refused(with_sensor([*good[:k], wrong_value, *good[k + 1 :]], reals))


def test_a_norm_has_two_or_three_components_and_an_order_below_two() -> None:
    builder = everything()
    for integers in ([0, 1, 0], [0, 4, 0, 0, 0, 0], [2, 2, 0, 0]):
        builder.sensors[-1] = (SensorType.NORM, integers, [])
        assert "'sen_int'" in refused(builder.to_bytes())


def with_changes(**changes: dict[int, int]) -> bytes:
    """The System of `everything` with other integers at places of arrays."""
    arrays = everything().arrays()
    for name, values in changes.items():
        array = np.array(arrays[name])
        for place, value in values.items():
            array[place] = value
        arrays[name] = array
    return pack(arrays)


def test_places_in_fronts_are_those_of_their_coordinates() -> None:
    """Wrong numbers within the range: nothing else would notice them."""
    arrays = {name: np.array(values).tolist() for name, values in everything().arrays().items() if name != "meta"}
    ptr, idx, places = arrays["front_ptr"], arrays["front_idx"], arrays["front_map"]
    first, pivots = ptr[0], arrays["front_col"][1]
    a, b = first + pivots, first + pivots + 1  # two coordinates of the first front that its parent has too
    assert b < ptr[1]
    swapped = {"front_idx": {a: idx[b], b: idx[a]}, "front_map": {a: places[b], b: places[a]}}
    assert "the coordinates of front 0 do not ascend" in refused(with_changes(**swapped))
    assert "of front 0 is not in its parent" in refused(with_changes(front_map={a: places[b]}))
    assert "of element 0 is not in front" in refused(with_changes(el_loc={0: arrays["el_loc"][1]}))
    size = arrays["row_ptr"][1]
    assert f"of a row with {size}" in refused(with_changes(quad_a={0: size}))
    assert "'sig_ptr' decreases at item 1" in refused(with_changes(sig_ptr={1: 5}))


def test_numbers_that_no_model_has_are_refused_by_name() -> None:
    def other(name: str, value: float) -> bytes:
        arrays = everything().arrays()
        arrays[name] = [value, *list(arrays[name])[1:]]  # type: ignore[call-overload]
        return pack(arrays)

    assert "the mass of coordinate 0 is -1" in refused(other("mass_val", -1.0))
    for value in (-1.0, 1001.0):
        assert f"parameter 0 is {value:g}, outside its range" in refused(other("par_value", value))


def test_the_directory_names_each_array_once_and_inside_the_file() -> None:
    data = everything().to_bytes()
    count = int.from_bytes(data[12:16], "little")
    twice = data.replace(b"qd0\0", b"q0\0\0", 1)
    assert "array 'q0' appears twice" in refused(seal(twice, count))
    at = 32 + 64 * list(everything().arrays()).index("meta")  # 40 bytes of name, 8 of type, 8 of offset, 8 of count
    offset = int.from_bytes(data[at + 48 : at + 56], "little")
    beyond = bytearray(data)
    beyond[at + 56 : at + 64] = (len(data) - offset + 1).to_bytes(8, "little")
    assert "array 'meta' lies outside the file" in refused(seal(bytes(beyond), count))


def test_every_truncation_is_refused() -> None:
    data = everything().to_bytes()
    for n in [*range(0, 200, 7), *range(200, len(data), 997), len(data) - 1]:
        refused(data[:n])
    refused(data + b"\0")


def test_every_flipped_bit_is_refused() -> None:
    data = everything().to_bytes()
    rng = np.random.default_rng(SEED)
    for position in [*range(32 * 8), *rng.integers(32 * 8, len(data) * 8, 200)]:
        damaged = bytearray(data)
        damaged[position // 8] ^= 1 << (position % 8)
        refused(bytes(damaged))


@BUILDERS
def test_flipped_bits_under_a_right_checksum_never_crash(builder: Builder) -> None:
    data = builder().to_bytes()
    count = int.from_bytes(data[12:16], "little")
    rng = np.random.default_rng(SEED + 1)
    accepted = 0
    for _ in range(800):
        damaged = bytearray(data)
        for position in rng.integers(32 * 8, len(data) * 8, rng.integers(1, 4)):
            damaged[position // 8] ^= 1 << (position % 8)
        accepted += exercise(seal(bytes(damaged), count))
    assert 25 < accepted < 775  # both ways were walked


@BUILDERS
@pytest.mark.parametrize("value", [-2, 1, 7, (1 << 31) - 1])
def test_every_integer_may_be_hostile(builder: Builder, value: int) -> None:
    arrays = builder().arrays()
    for name in sorted(INTS):
        for k in range(len(np.atleast_1d(arrays[name]))):  # type: ignore[arg-type]
            hostile = np.array(arrays[name], dtype=np.int64)
            hostile[k] = value
            exercise(pack(arrays | {name: hostile}))


@BUILDERS
def test_numbers_that_are_not_finite_are_refused(builder: Builder) -> None:
    arrays = builder().arrays()
    for name in sorted(REALS - {"input_min", "input_max", "par_min", "par_max"}):
        if not len(np.atleast_1d(arrays[name])):  # type: ignore[arg-type]
            continue
        for value in (np.nan, np.inf):
            hostile = np.array(arrays[name], float)
            hostile[-1] = value
            assert name in refused(pack(arrays | {name: hostile}))


@BUILDERS
@pytest.mark.parametrize("value", [-1e300, 0.0])
def test_extreme_reals_never_crash(builder: Builder, value: float) -> None:
    arrays = builder().arrays()
    for name in sorted(REALS):
        for k in range(len(np.atleast_1d(arrays[name]))):  # type: ignore[arg-type]
            hostile = np.array(arrays[name], float)
            hostile[k] = value
            exercise(pack(arrays | {name: hostile}))


@BUILDERS
def test_arrays_of_a_wrong_length_are_refused(builder: Builder) -> None:
    arrays = builder().arrays()
    for name in sorted(INTS | REALS):
        values = np.atleast_1d(arrays[name])  # type: ignore[arg-type]
        more = 1 if len(values) else 7  # an array that may be left out has one entry for each of what is there
        refused(pack(arrays | {name: np.append(values, np.zeros(more))}))
        if len(values):
            exercise(pack(arrays | {name: values[:-1]}))


def test_a_missing_and_an_unknown_array_are_named() -> None:
    arrays = everything().arrays()
    assert "'row_scale' is missing" in refused(pack({k: v for k, v in arrays.items() if k != "row_scale"}))
    renamed = {("colour" if k == "meta" else k): (b"" if k == "meta" else v) for k, v in arrays.items()}
    assert "unknown array 'colour'" in refused(pack({k: [] if k == "colour" else v for k, v in renamed.items()}))


def test_fronts_of_impossible_size_are_refused_without_asking_for_memory() -> None:
    arrays = four_bar().arrays()
    assert "fronts" in refused(pack(arrays | {"front_off": [0, (1 << 31) - 1]}))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ported_ptr": [0, 1, 3, 4]}, "'ported_ptr' runs from 0 to 4 instead of 0 to 3"),
        ({"ported_ptr": [0] * 7, "ported_row": [], "ported_val": []}, "6 coordinates without ports"),
        ({"ported_row": [0, 5, 2]}, "'ported_row' is 5"),
        ({"fineness": [0.0]}, "the fineness is 0"),
        ({"ported_const": [0.0]}, "'ported_const' has 1 items instead of 5"),
        ({"ported_ptr": []}, "'ported_row' has 3 items instead of 0"),
        ({"ported_lam_ptr": [0, 1, 3]}, "'ported_lam_ptr' runs from 0 to 3 instead of 0 to 2"),
        ({"ported_lam_row": [0, 3]}, "'ported_lam_row' is 3"),
        ({"ported_force_ptr": [0, 1, 1, 2]}, "'ported_force_ptr' runs from 0 to 2 instead of 0 to 1"),
        ({"ported_force_col": [5]}, "'ported_force_col' is 5"),
    ],
)
def test_a_map_of_ports_that_points_elsewhere_is_refused(changes: dict[str, list[float]], message: str) -> None:
    good = {"ported_ptr": [0, 1, 3], "ported_row": [0, 1, 2], "ported_val": [1.0] * 3, "ported_const": [0.0] * 5}
    good |= {"ported_lam_ptr": [0, 1, 2], "ported_lam_row": [0, 1], "ported_lam_val": [1.0] * 2}
    good |= {"ported_force_ptr": [0, 0, 0, 1], "ported_force_col": [0], "ported_force_val": [1.0]}
    arrays = sleigh().arrays()
    assert (len(arrays["q0"]), len(arrays["row_const"])) == (5, 3)
    LoadedSystem(pack(arrays | good))
    assert message in refused(pack(arrays | good | changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"row_const": [-0.5, 0.1, 0.0]}, "velocity row 1 also has a condition on positions"),
        ({"quad_ptr": [0, 1, 2, 2]}, "velocity row 1 also has a condition on positions"),
        (
            {
                "gterm_row": [2],
                "gterm_guide": [0],
                "gterm_power": [1],
                "gterm_a": [0],
                "gterm_b": [-1],
                "gterm_h": [1.0],
            }
            | {
                "guide_type": [1],
                "guide_input": [0],
                "guide_parameter": [20.0, 0.5, 0.0],
                "guide_parameter_ptr": [0, 3],
            },
            "velocity row 2 also has a condition on positions",
        ),
        (
            {"angle_row": [1], "angle_theta": [0], "angle_ptr": [0, 1], "angle_a": [1], "angle_b": [-1]}
            | {"angle_hc": [1.0], "angle_hs": [0.0]},
            "velocity row 1 also has a condition on positions",
        ),
        ({"velocity_row": [2, 1]}, "does not ascend"),
        ({"velocity_row": [1, 3]}, "'velocity_row' is 3"),
        ({"velocity_ptr": [0, 4, 5]}, "'velocity_ptr' runs from 0 to 5 instead of 0 to 6"),
        ({"velocity_a": [4, 2, 3, 3, 2, 3]}, "'velocity_a' is 4"),
        ({"velocity_b": [1, 3, 0, 2, 0, -1]}, "'velocity_b' is -1"),
    ],
)
def test_a_velocity_row_that_is_more_or_less_is_refused(changes: dict[str, list[float]], message: str) -> None:
    assert message in refused(pack(sleigh().arrays() | changes))


def test_a_wheel_on_a_table_that_is_not_named_is_refused() -> None:
    """Its signals are dependents, for which the mass matrix has no rows to look into."""
    arrays = dict(compile(prototype_car.build(fidelity=10)).arrays) | {"meta": b""}
    assert min(arrays["axis_table"]) >= 0
    message = "a wheel whose axis has no table is on a lookup-table body"
    table = np.array(arrays["axis_table"])
    table[-1] = -1
    assert message in refused(pack(arrays | {"axis_table": table}))


@pytest.mark.slow
@pytest.mark.parametrize("build", [bricard.build, lambda: hinge(0.1)], ids=["Bricard", "angle"])
def test_a_hostile_tree_never_crashes_nor_gives_infinite_coordinates(build: Callable[[], Model]) -> None:
    assert accepted_by_walks(dict(compile(build()).arrays), ("tree_",)) > 20


@pytest.mark.slow
def test_hostile_axes_guides_and_parameters_of_a_car_never_crash() -> None:
    """A car whose wheels may be turned and whose rack goes by a table."""
    car = load("prototype").changed({"steering.rack_by_wheel_angle": [[0.0, 0.0], [150.0, 18.0], [420.0, 66.0]]})
    assert accepted_by_walks(dict(compile(car.model()).arrays), ("axis_", "guide_", "inertia_", "par_")) > 150


def accepted_by_walks(arrays: dict[str, Any], starts: tuple[str, ...]) -> int:
    """How many files are loaded and run: integers out of range or out of place, reals at random, 12 an array."""
    rng = np.random.default_rng(SEED + 2)
    names = sorted(name for name in arrays if name.startswith(starts) and len(arrays[name]))
    accepted = 0
    for name in names:
        integers, size = name in INTS, len(arrays[name])
        for k in rng.choice(size, min(size, 12), replace=False):
            for value in (-1, 0, 1, 7, 66, 1 << 30) if integers else (rng.choice([0.0, -1.0, 1e-300, 1e150, -1e300]),):
                hostile = np.array(arrays[name])
                hostile[k] = value
                accepted += walked(pack(arrays | {name: hostile, "meta": b""}))
    return accepted


def walked(data: bytes) -> bool:
    try:
        instance = Instance(LoadedSystem(data))
    except KernelError:
        return False
    for method in ("semi_recursive_4", "runge_kutta_8", "semi_recursive"):
        try:
            instance.initialise(0.0)
            instance.set_settings(**METHODS[method])
            instance.run(0.01, 2)
        except KernelError:
            pass
        assert all(np.isfinite(np.array(part)).all() for part in instance.get_state())
    return True
