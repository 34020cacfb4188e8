"""Pest records as they were brought, and which of them speak on a day."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import ObservationError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.prior.record_kernel import record_chance
from fieldmon.infestation.records import ABSENT, PRESENT, UNKNOWN, Records, usable
from tests.infestation.prior.placed_records import GRID, MIDDLE, TODAY, at_middle, together


def test_columns_that_are_not_given_are_unknown():
    records = Records.of([[35.0, 30.0], [35.1, 30.1]], [PRESENT, ABSENT])
    assert records.lonlat.shape == (2, 2)
    assert records.present.dtype == np.int8
    assert np.isnat(records.day).all()
    assert np.isnan([records.count, records.accuracy_m, records.leaves_sampled]).all()
    assert records.species.tolist() == records.stage.tolist() == ["", ""]


def test_one_day_is_that_of_all():
    for day in ("2026-11-18", np.datetime64("2026-11-18")):
        records = Records.of([[35.0, 30.0]] * 2, [PRESENT, ABSENT], day)
        assert records.day.astype(str).tolist() == ["2026-11-18"] * 2


def test_columns_of_other_lengths_are_refused_by_name():
    with pytest.raises(ObservationError, match="2 entries, but count has 3"):
        Records.of([[35.0, 30.0]] * 2, [PRESENT, ABSENT], count=np.zeros(3))


def test_some_of_them_are_taken_by_mask_or_by_number_in_that_order():
    records = Records.of(
        [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]], [1, 0, -1], count=np.array([7.0, 8.0, 9.0])
    )
    assert records.take(np.array([2, 0])).count.tolist() == [9.0, 7.0]
    assert records.take(records.present == ABSENT).lonlat.tolist() == [[3.0, 4.0]]
    assert len(Records.none()) == 0


def test_a_record_is_of_a_plot_within_100_m_or_twice_its_own_accuracy():
    records = Records.of(
        np.zeros((3, 2)), np.zeros(3, np.int8), accuracy_m=np.array([np.nan, 5.0, 80.0])
    )
    assert records.reach_m().tolist() == [100.0, 100.0, 160.0]


def test_nobody_can_change_them():
    records = at_middle(PRESENT)
    with pytest.raises(ValueError, match="read-only"):
        records.lonlat[0, 0] = 0.0


def test_a_record_of_today_is_not_of_the_future_at_any_hour():
    assert usable(at_middle(PRESENT), np.datetime64("2026-05-20T05:00")).future == 0


def test_records_that_say_neither_and_those_of_tomorrow_are_left_out_and_told_of():
    records = together(
        at_middle(PRESENT, 3),
        at_middle(UNKNOWN, 3),
        at_middle(UNKNOWN, -3),
        at_middle(PRESENT, -1),
        Records.of(GRID.lonlat()[:2], [PRESENT, ABSENT]),
    )
    kept = usable(records, TODAY)
    assert len(kept.records) == 3
    assert (kept.undecided, kept.future, kept.undated) == (2, 1, 2)
    assert [sentence.split()[0] for sentence in kept.messages()] == ["2", "1", "2"]
    assert not usable(at_middle(PRESENT), TODAY).messages()


@pytest.mark.parametrize(("days", "old"), [(0, 0), (70, 0), (71, 1), (300, 1), (10_000, 1)])
def test_records_so_old_that_they_hardly_count_are_told_of(days, old):
    kept = usable(at_middle(PRESENT, days), TODAY)
    assert (kept.old, len(kept.records)) == (old, 1)
    said = "1 of the records is more than 70 days old and hardly counts."
    assert kept.messages() == (said,)[:old]


def test_how_old_that_is_follows_from_the_half_life_of_records():
    short = PriorSettings(half_life_days=4.0)
    kept = usable(at_middle(PRESENT, 21), TODAY, short)
    assert kept.messages() == ("1 of the records is more than 20 days old and hardly counts.",)
    undated = replace(at_middle(PRESENT), day=np.array(["NaT"], "datetime64[D]"))
    said = "1 of the records has no date and counts as 9 days old, whatever day is planned."
    assert usable(undated, TODAY, PriorSettings(undated_days=9.0)).messages() == (said,)
    # a thirtieth of what it says on its own day
    nothing = np.zeros(len(GRID))
    new, old = (
        record_chance(GRID, nothing, at_middle(PRESENT, days), TODAY, short)[MIDDLE]
        for days in (0, 20)
    )
    assert new / 40 < old < new / 20


@pytest.mark.parametrize(
    ("present", "columns", "said"),
    [
        (PRESENT, {"count": -5.0}, "count must be numbers from 0 on, but one is -5"),
        (PRESENT, {"count": np.inf}, "count must be numbers from 0 on, but one is inf"),
        (PRESENT, {"accuracy_m": -5.0}, "accuracy_m must be"),
        (ABSENT, {"leaves_sampled": -3.0}, "leaves_sampled must be"),
    ],
)
def test_numbers_that_cannot_be_are_refused(present, columns, said):
    given = {name: np.array([value]) for name, value in columns.items()}
    with pytest.raises(ObservationError, match=said):
        Records.of(np.array([[35.15, 30.36]]), np.array([present]), **given)


@pytest.mark.parametrize(
    ("days", "said"),
    [
        (["2024-08-11", "2024-06-03"], "2 records of 2024-06-03 to 2024-08-11"),
        (["2024-06-03"], "1 record of 2024-06-03"),
        (["NaT", "NaT"], "2 records without a date"),
        (["2024-06-03", "NaT"], "2 records of 2024-06-03, 1 of them without a date"),
    ],
)
def test_records_are_said_with_their_days(days, said):
    records = Records.of(
        [[35.0, 30.0]] * len(days), [1] * len(days), np.array(days, "datetime64[D]")
    )
    assert records.in_words() == said
    assert records.sentence() == f"Chances and hot spots begin with {said}."


def test_a_callers_arrays_stay_his_own_and_change_no_records():
    lonlat, day = np.array([[35.1, 30.3], [35.2, 30.4]]), np.array(["2026-04-06", "NaT"], "M8[D]")
    given = [lonlat, np.array([1, 0], np.int8), day]
    made = Records.of(*given)
    before = {name: values.copy() for name, values in vars(made).items()}
    for values in given:
        values[:] = values[::-1].copy()
    for name, values in before.items():
        np.testing.assert_array_equal(getattr(made, name), values)
