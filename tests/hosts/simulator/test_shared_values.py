"""Two processes share values without waiting for each other, and no reader sees half a record."""

import multiprocessing

import numpy as np
import pytest

from hosts.simulator.shared_values import ByteRing, Ring, SharedValues, Sizes, TwoSlots

SIZES = Sizes(inputs=2, columns=300, rows=8)
STEPS = 20000
_DONE = 7
_SEEN = 6


def hammer(name: str) -> None:
    """Writes moments as fast as it can, each of equal values, until enough were seen."""
    shared, k = SharedValues(SIZES, name), 0
    while k < STEPS or not shared.flags[_SEEN]:
        k += 1
        slot = shared.moments.begin()
        for part in np.array_split(slot, 5):
            part[:] = k
        shared.moments.finish()
    del slot, part  # memory that is looked at cannot be given back
    shared.flags[_DONE] = 1
    shared.close()


@pytest.mark.slow
def test_no_record_is_torn_or_older_than_the_one_before() -> None:
    shared = SharedValues(SIZES)
    process = multiprocessing.get_context("spawn").Process(target=hammer, args=(shared.name,))
    process.start()
    last, seen = 0.0, 0
    while not shared.flags[_DONE]:
        record = shared.moments.read()
        assert record.min() == record.max() >= last
        seen += record[0] != last
        last = float(record[0])
        shared.flags[_SEEN] = seen > 50  # the processes do run at the same time
        if process.exitcode is not None:
            break
    process.join()
    assert process.exitcode == 0
    assert shared.moments.read()[0] >= STEPS
    assert seen > 50
    shared.close()


def test_a_writer_that_dies_in_a_record_leaves_the_one_before() -> None:
    slots = TwoSlots(np.zeros(2, np.int64), np.zeros((2, 4)))
    slots.begin()[:] = 1.0
    slots.finish()
    slots.begin()[:2] = 2.0
    assert slots.read().tolist() == [1.0] * 4


def test_an_overtaken_reader_keeps_its_record_after_a_few_tries() -> None:
    counters, values = np.zeros(2, np.int64), np.zeros((2, 4))
    reader, writer = TwoSlots(counters, values), TwoSlots(counters, values)
    writer.begin()[:] = 1.0
    writer.finish()
    assert reader.read().tolist() == [1.0] * 4
    counters[0] = 5  # the writer is always two records ahead
    assert reader.read().tolist() == [1.0] * 4


def test_a_ring_without_room_refuses_and_loses_nothing_that_it_has() -> None:
    ring = Ring(np.zeros(2, np.int64), np.zeros((4, 2)))
    for k in range(4):
        assert ring.has_room()
        ring.slot()[:] = k
        ring.finish()
    assert not ring.has_room()
    assert ring.take().tolist() == [[k, k] for k in range(4)]
    assert ring.has_room()
    assert ring.take().shape == (0, 2)


@pytest.mark.parametrize("size", [50, 64, 101])
def test_messages_wrap_around(size: int) -> None:
    ring = ByteRing(np.zeros(2, np.int64), np.zeros(size, np.uint8))
    for k in range(200):
        sent = [b"x" * (k % 7), str(k).encode() * 3]
        assert all(map(ring.put, sent))
        assert ring.take() == sent
    assert not ring.put(b"y" * size)
    assert ring.take() == []


@pytest.mark.parametrize("counters", [[2**62, 0], [-(2**62), 5], [3, 2**62]])
def test_counters_that_an_fmu_has_damaged_give_no_more_than_there_is(counters: list[int]) -> None:
    rows = Ring(np.array(counters), np.zeros((4, 2)))
    assert len(rows.take()) <= 4
    assert len(b"".join(ByteRing(np.array(counters), np.full(50, 255, np.uint8)).take())) <= 50
