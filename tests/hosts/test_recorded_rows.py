"""Rows of a run: changes of inputs that the rows represent, jumps, and lost changes."""

from hosts.driving.recorded_rows import RecordedRows

HELD, STRAIGHT, ALONE = range(3)
"""Inputs: one that is held over a step, one that goes straight, one that nothing sets."""


class Outputs:
    """One output that counts the readings."""

    def __init__(self) -> None:
        self.read = 0

    def __len__(self) -> int:
        return 1

    def whole(self) -> list[float]:
        self.read += 1
        return [float(self.read)]


def rows(every: int) -> RecordedRows:
    return RecordedRows(Outputs(), [1.0, 2.0, 3.0], [HELD, STRAIGHT], [STRAIGHT], [10.0], every, 6)  # type: ignore[arg-type]


def step(recorded: RecordedRows, held: float, begin: float, end: float) -> None:
    recorded.begin([held, begin])
    recorded.move([end], [end - begin])
    recorded.end()


def test_a_jump_is_a_straight_input_that_begins_elsewhere_and_any_at_the_start() -> None:
    recorded = rows(1)
    step(recorded, 1.5, 2.0, 2.4)  # the held input jumps at the start
    step(recorded, 1.7, 2.4, 2.6)  # later a new row tells it
    step(recorded, 1.7, 3.0, 3.2)  # the straight one begins elsewhere than it ended
    step(recorded, 1.7, 3.2 * (1.0 + 1e-12), 3.3)  # round-off is none
    assert recorded.jumps == {0: [1.0, 2.0, 3.0], 2: [1.7, 2.6, 3.0]}
    assert not recorded.lost
    steps, values = recorded.close(False)
    assert steps == [0, 1, 2, 3, 4]
    assert values[:4].tolist() == [
        [1.5, 2.0, 3.0, 1.0],
        [1.7, 2.4, 3.0, 2.0],
        [1.7, 3.0, 3.0, 3.0],
        [1.7, 3.2 * (1.0 + 1e-12), 3.0, 4.0],
    ]
    assert values[4].tolist() == [1.7, 3.3, 3.0, 5.0]


def test_no_jump_where_all_go_on_from_the_start() -> None:
    recorded = rows(1)
    step(recorded, 1.0, 2.0, 2.5)
    step(recorded, 1.0, 2.5, 3.0)
    assert recorded.jumps == {}


def test_between_rows_a_change_otherwise_than_straight_is_lost() -> None:
    recorded = rows(2)
    step(recorded, 1.0, 2.0, 2.2)
    step(recorded, 1.0, 2.2, 2.4)  # as straight as before
    assert not recorded.lost
    step(recorded, 1.0, 2.4, 2.6)
    step(recorded, 1.0, 2.6, 2.7)  # bends between the rows
    assert recorded.lost == {STRAIGHT}
    step(recorded, 1.0, 2.7, 2.8)
    step(recorded, 1.2, 2.8, 2.9)  # the held one changes between the rows
    assert recorded.lost == {HELD, STRAIGHT}
    assert list(recorded.jumps) == [0, 1, 2]  # rows apart do not tell what was before them
    steps, _ = recorded.close(True)
    assert steps == [0, 2, 4, 6]


def test_behind_a_refused_step_there_is_no_row() -> None:
    recorded = rows(2)
    step(recorded, 1.0, 2.0, 2.2)
    recorded.begin([1.4, 2.2])
    recorded.move([2.4], [0.2])
    recorded.refused = True
    assert recorded.close(True)[0] == recorded.close(False)[0] == [0]
