"""Recordings: what is checked, what is taken out and said, and how they are thinned."""

import tracemalloc
from typing import Any

import numpy as np
import pytest

from ali3.scene.errors import ViewerError
from ali3.scene.recording import MAX_TIMES, Recording
from ali3.scene.scene_columns import all_columns
from tests.viewer.hand_scenes import crank, everything

TIMES = np.linspace(0.0, 2.0, 21)


def full(**changed: Any) -> Recording:
    columns = {name: np.ones(21) for name in all_columns(everything())} | changed
    return Recording(everything(), TIMES, {name: x for name, x in columns.items() if x is not None})


def test_a_whole_recording_draws_all() -> None:
    recording = full()
    assert recording.missing == [{"name": "lower arm", "why": "no output gives its motion"}]
    assert recording.scene is not None
    assert len(recording.scene["shapes"]) == len(everything()["shapes"])
    assert recording.notes == []


@pytest.mark.parametrize(
    ("t", "sentence"),
    [
        ([], r"shape \(0,\)"),
        ([[0.0]], r"shape \(1, 1\)"),
        (["a"], "not numbers"),
        ([0.0, np.nan], "time 1 .* is nan"),
        ([0.0, 2.0, 1.0], "go back from 2 s to 1 s"),
    ],
)
def test_invalid_times_are_refused(t: Any, sentence: str) -> None:
    with pytest.raises(ViewerError, match=sentence):
        Recording(None, t, {})


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (np.ones(20), r"'x' has the shape \(20,\); there are 21 times"),
        (np.ones((21, 1)), r"shape \(21, 1\)"),
        (["a"] * 21, "contains no numbers"),
        (np.ones(21, complex), "complex128"),
    ],
)
def test_invalid_columns_are_refused(values: Any, sentence: str) -> None:
    with pytest.raises(ViewerError, match=sentence):
        Recording(None, TIMES, {"x": values})


def test_what_the_columns_do_not_move_is_taken_out_with_all_that_stands_on_it() -> None:
    recording = full(**{"body.y": None})
    assert recording.scene is not None
    assert recording.scene["frames"] == {}
    assert recording.scene["shapes"] == []
    assert recording.scene["focus"] == ""
    why = {item["name"]: item["why"] for item in recording.missing}
    assert why["body"] == why["spinning wheel"] == why["arm"] == "the result has no column 'body.y'"


def test_a_result_without_poses_is_reported_in_one_sentence() -> None:
    recording = Recording(everything(), TIMES, {"speed": TIMES})
    assert recording.scene is None
    assert recording.missing == []
    (note,) = recording.notes
    assert note.endswith(
        "is not drawn: the result has none of its poses, such as the column 'body.x'; its signals can be plotted."
    )


def test_a_missing_column_removes_only_the_parts_that_need_it() -> None:
    recording = full(angle=None, **{"spring.force": None, "body.mode_1": None})
    assert recording.scene is not None
    assert set(recording.scene["frames"]) == {"body", "arm"}
    assert [shape["kind"] for shape in recording.scene["shapes"]] == [
        *("box", "sphere", "cylinder", "tube", "plate", "mesh", "spring", "damper")
    ]
    assert [arrow["name"] for arrow in recording.scene["arrows"]] == ["pin", "tyre"]
    assert recording.scene["flexible"] == []
    names = [item["name"] for item in recording.missing]
    assert names == ["lower arm", "spinning wheel", "deformation of frame", "arrow spring"]


def test_a_column_without_any_number_is_missing_and_one_with_gaps_is_reported() -> None:
    gaps = np.where((TIMES > 0.5) & (TIMES < 1.0), np.nan, 1.0)
    recording = full(angle=np.full(21, np.nan), **{"body.x": gaps})
    assert {"name": "spinning wheel", "why": "the column 'angle' holds no number"} in recording.missing
    assert recording.notes == [
        "The column 'body.x' has 4 of 21 values that are not numbers, the first at 0.6 s; there is nothing drawn for "
        "them."
    ]


def test_numbers_that_no_picture_holds_are_reported_and_not_drawn() -> None:
    recording = full(**{"body.x": np.where(TIMES > 1.0, 1e300, 1.0), "body.y": np.where(TIMES > 1.5, np.inf, 1.0)})
    assert np.array_equal(np.isfinite(recording.columns["body.x"]), TIMES <= 1.0)
    assert recording.notes[0] == "The column 'body.x' has 10 of 21 values beyond 1e+30."
    assert any(
        note.startswith("The column 'body.x' has 10 of 21 values that are not numbers") for note in recording.notes
    )


def test_an_angle_within_one_turn_becomes_continuous() -> None:
    angle = 10.0 * TIMES
    wrapped = (angle + np.pi) % (2.0 * np.pi) - np.pi
    recording = full(angle=wrapped)
    np.testing.assert_allclose(recording.columns["angle"], angle, atol=1e-12)
    assert "'angle' was given within one turn" in recording.notes[0]
    other = full(angle=angle)
    np.testing.assert_array_equal(other.columns["angle"], angle)
    assert other.notes == []


def test_the_drawn_pose_is_added_if_there_is_none() -> None:
    recording = crank(TIMES)
    assert recording.scene is not None
    assert recording.scene["frames"]["slider"]["start"] == [[1.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]


def test_thinning_is_uniform_in_time_and_reported() -> None:
    t = np.concatenate([np.linspace(0.0, 1.0, 90_001), np.linspace(1.0, 10.0, 10_001)[1:]])
    recording = crank(t)
    shown = recording.thinned(1000)
    assert len(shown.t) <= 1000
    assert (shown.t[0], shown.t[-1]) == (0.0, 10.0)
    assert np.diff(shown.t).max() < 1.2 * np.diff(shown.t).min()
    np.testing.assert_allclose(shown.columns["angle"], 2.0 * shown.t)
    assert shown.notes[0].startswith(f"{len(shown.t)} of 100001 times are shown, one every 0.01 s.")
    assert recording.thinned(200_000) is recording
    assert recording.notes == []


def test_thinning_reports_the_error_of_the_motion_between() -> None:
    rate, step = 30.0, 0.05
    shown = crank(np.linspace(0.0, 10.0, 20_001), rate).thinned(201)
    note = shown.notes[0]
    # Between orientations the arc is exact at a constant rate: nothing is said of the crank. The slider's place is a
    # chord: its sagitta is the largest acceleration, (r + r²/l) w² at the outer dead centre, times h² / 8.
    assert "direction" not in note
    far = float(note.split("'slider' by up to ")[1].split(" m")[0])
    assert far == pytest.approx((0.5 + 0.25) * rate**2 * step**2 / 8.0, rel=0.15)


@pytest.mark.parametrize("reset", [False, True])
def test_a_jump_is_kept_and_is_no_difference_from_the_record(reset: bool) -> None:
    """A time that stands twice, or another epoch from one time to the next."""
    before, after = crank(np.linspace(0.0, 5.0, 10_001)), crank(np.linspace(5.0 + 1e-3 * reset, 10.0, 10_001))
    columns = {n: np.concatenate([x, after.columns[n] + 3.0]) for n, x in before.columns.items()}
    t, epoch = np.concatenate([before.t, after.t]), np.repeat([4, 5], 10_001)
    shown = Recording(before.scene, t, columns, epoch=epoch if reset else None).thinned(202)
    assert len(shown.t) <= 202
    (step,) = np.flatnonzero(np.diff(shown.epoch if reset else -np.sign(np.diff(shown.t, prepend=-1.0))) > 0.0)
    assert shown.t[step] == 5.0
    for name, values in columns.items():
        assert shown.columns[name][step : step + 2].tolist() == values[10_000:10_002].tolist()
    assert "place" not in "".join(shown.notes)


def test_of_many_resets_the_last_pose_stands_until_the_next() -> None:
    """More than thinning keeps: nothing is said to be drawn from one epoch to another, but that it stands still."""
    t = np.linspace(0.0, 10.0, 20_001)
    result = crank(t, 0.1)
    result.columns["slider.x"] = result.columns["slider.x"] + 50.0 * (np.arange(len(t)) % 2)
    result.epoch = np.arange(len(t)) // 1.0
    shown = result.thinned(101)
    assert len(shown.t) == len(shown.epoch) == 101
    assert "the place of 'slider' by up to 50 m" in shown.notes[0]


def test_invalid_epochs_are_refused() -> None:
    with pytest.raises(ViewerError, match=r"'epoch' has the shape \(20,\); there are 21 times"):
        Recording(None, TIMES, {}, epoch=np.ones(20))


def test_a_turn_that_thinning_loses_is_reported() -> None:
    shown = crank(np.linspace(0.0, 10.0, 20_001), 100.0).thinned(101)
    assert "the direction of 'crank' by up to" in shown.notes[0]


def test_a_million_times_in_bounded_memory() -> None:
    recording = crank(np.linspace(0.0, 1000.0, 1_000_001))
    tracemalloc.start()
    shown = recording.thinned()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(shown.t) == MAX_TIMES
    assert peak < 100e6  # the record itself has 160 MB


@pytest.mark.parametrize("most", [1, 0, -3, 2.5, True, "many"])
def test_an_invalid_number_of_times_is_refused(most: Any) -> None:
    with pytest.raises(ViewerError, match="whole number of 2 or more"):
        crank(TIMES).thinned(most)


def test_a_part_of_the_time() -> None:
    part = crank(TIMES).between(0.5, 1.0)
    np.testing.assert_allclose(part.t, np.linspace(0.5, 1.0, 6))
    np.testing.assert_allclose(part.columns["angle"], 2.0 * part.t)
    with pytest.raises(ViewerError, match="no time from 3 s to 4 s in 'crank'; it was recorded from 0 s to 2 s"):
        crank(TIMES).between(3.0, 4.0)
