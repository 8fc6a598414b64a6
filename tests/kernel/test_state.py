"""States as bytes: a restored instance continues bit for bit; altered bytes are refused and change nothing."""

import zlib

import numpy as np
import pytest

from mbs.kernel import binding
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance

from .scenes import everything, four_bar

SEED = 7


def moving() -> Instance:
    instance = Instance(LoadedSystem(everything().to_bytes()))
    instance.set_settings(eps_rel=3e-9)
    instance.initialise(0.25)
    instance.set_input(0, 0.4)
    instance.set_parameter(0, 450.0)
    for _ in range(25):
        instance.step(0.01)
    return instance


def bits(instance: Instance) -> list[bytes]:
    return [bytes(part) for part in (*instance.get_state(), instance.sensors())] + [np.float64(instance.time).tobytes()]


def test_a_restored_state_continues_bit_for_bit_in_another_instance() -> None:
    instance = moving()
    saved = instance.save()
    other = Instance(LoadedSystem(everything().to_bytes()))
    other.restore(saved)
    assert bits(other) == bits(instance)
    assert other.settings() == instance.settings()
    assert other.get_parameter(0) == 450.0
    assert other.save() == saved
    for _ in range(50):
        instance.step(0.01)
        other.step(0.01)
    assert bits(other) == bits(instance)
    assert other.report() == instance.report()


def test_altered_bytes_are_refused_and_change_nothing() -> None:
    instance = moving()
    before, saved = bits(instance), instance.save()
    rng = np.random.default_rng(SEED)
    bad = [saved[:n] for n in (0, 1, 39, len(saved) - 1)] + [saved + b"\0"]
    for position in [*range(0, 40 * 8, 5), *rng.integers(0, len(saved) * 8, 200)]:
        altered = bytearray(saved)
        altered[position // 8] ^= 1 << (position % 8)
        bad.append(bytes(altered))
    for data in bad:
        with pytest.raises(KernelError) as refusal:
            instance.restore(data)
        assert refusal.value.status == binding.Status.BAD_STATE
    assert bits(instance) == before


def test_a_state_of_another_system_is_refused() -> None:
    other = Instance(LoadedSystem(four_bar().to_bytes()))
    other.initialise()
    with pytest.raises(KernelError) as refusal:
        other.restore(moving().save())
    assert refusal.value.status == binding.Status.BAD_STATE


def test_reset_goes_back_to_the_file() -> None:
    instance = moving()
    instance.reset()
    fresh = Instance(LoadedSystem(everything().to_bytes()))
    assert instance.settings() == fresh.settings()
    assert instance.get_input(0) == fresh.get_input(0)
    assert instance.get_parameter(0) == fresh.get_parameter(0)
    for i in (instance, fresh):
        i.initialise(0.0)
        i.step(0.01)
    assert bits(instance) == bits(fresh)


def test_a_filtered_guide_starts_at_rest_where_its_input_holds_it() -> None:
    """Also where the instance was stepped before, and the driving function moved."""
    b = everything()
    b.sensors = [(12, [0, order], [1.0]) for order in range(3)]
    instance = Instance(LoadedSystem(b.to_bytes()))
    instance.initialise(0.0)
    instance.set_input(0, 0.4)
    instance.step(0.01)
    assert min(abs(v) for v in instance.sensors()) > 1e-3
    instance.initialise(0.0)
    assert list(instance.sensors()) == [0.5 * 0.4, 0.0, 0.0]


def test_nothing_works_before_initialise() -> None:
    instance = Instance(LoadedSystem(four_bar().to_bytes()))
    for call in (lambda: instance.step(0.01), instance.sensors):
        with pytest.raises(KernelError) as refusal:
            call()
        assert refusal.value.status == binding.Status.NOT_INITIALISED


def test_arguments_out_of_range_are_refused() -> None:
    instance = moving()
    calls = [
        lambda: instance.set_input(1, 0.0),
        lambda: instance.set_input(-1, 0.0),
        lambda: instance.set_input(0, float("nan")),
        lambda: instance.set_parameter(0, 1000.5),
        lambda: instance.set_parameter(0, float("nan")),
        lambda: instance.set_pose(0.0, 0.0, 0.0, 0.0, 0.0),  # it is tied to the ground
        lambda: instance.set_q([float("inf")] * 5),
        lambda: instance.set_settings(max_iterations=0),
        lambda: instance.set_settings(eps_rel=float("nan")),
        lambda: instance.initialise(float("nan")),
    ]
    before = bits(instance)
    for call in calls:
        with pytest.raises(KernelError) as refusal:
            call()
        assert refusal.value.status == binding.Status.BAD_ARGUMENT
    assert bits(instance) == before
    instance.set_input(0, 5.0)
    assert instance.get_input(0) == 1.0  # clamped to its range


def forged(saved: bytes, at: int, value: float) -> bytes:
    """The number at a place replaced, under a checksum that fits."""
    data = bytearray(saved)
    data[at : at + 8] = np.float64(value).tobytes()
    data[24:28] = np.uint32(zlib.crc32(bytes(data[28:]))).tobytes()
    return bytes(data)


def test_an_input_out_of_its_range_is_refused_under_a_right_checksum() -> None:
    instance = moving()
    saved, sizes = instance.save(), instance.system.sizes
    at = len(saved) - 8 * (sizes.np + sizes.nu)
    assert np.frombuffer(saved[at : at + 8])[0] == instance.get_input(0) == 0.4
    before = bits(instance)
    for bad in (1e9, -1e9, np.inf, np.nan):
        with pytest.raises(KernelError) as caught:
            instance.restore(forged(saved, at, bad))
        assert caught.value.status == binding.Status.BAD_STATE
    assert bits(instance) == before
    instance.restore(forged(saved, at, 0.3))
    assert instance.get_input(0) == 0.3


def test_forged_numbers_never_give_infinite_outputs() -> None:
    instance = moving()
    saved = instance.save()
    rng = np.random.default_rng(SEED)
    taken = 0
    for _ in range(600):
        at = 40 + 8 * int(rng.integers((len(saved) - 40) // 8))
        value = float(rng.choice([1e300, -1e200, 1e155, 1e100, 1e30, -1e10, np.inf]))
        try:
            instance.restore(forged(saved, at, value))
        except KernelError:
            continue
        taken += 1
        assert np.isfinite(instance.sensors()[:]).all()
    assert taken > 40
