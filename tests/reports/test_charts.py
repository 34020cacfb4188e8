"""Charts of days: where values lie on paper."""

from datetime import date, timedelta

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.reports import colours
from fieldmon.reports.charts import DayChart
from fieldmon.reports.drawing import Areas, Discs, Lettering, Strokes

FIRST = date(2026, 11, 2)
SIZE = (186.0, 40.0)


def days(*numbers):
    return tuple(FIRST + timedelta(days=k) for k in numbers)


def parts(drawing, kind):
    return [part for part in drawing.parts if isinstance(part, kind)]


def heights(chart):
    """Return how high each value of a line lies above the foot, as a share of the top tick."""
    drawing = chart.draw(SIZE)
    (dots,) = parts(drawing, Discs)
    grid = next(one.lines for one in parts(drawing, Strokes) if one.colour == colours.FAINT)
    foot = next(one.lines[0] for one in parts(drawing, Strokes) if one.colour == colours.SOFT)
    top = min(line[0, 1] for line in grid)
    return (foot[0, 1] - dots.places[:, 1]) / (foot[0, 1] - top)


def line(values, *numbers, spread=1.0, **more):
    value = np.array(values, np.float64)
    low, high = np.maximum(value - spread, 0), value + spread
    return DayChart(days(*numbers), value, Units(), low, high, **more)


def test_bars_are_as_high_as_their_values_and_say_them():
    drawing = DayChart(days(0, 1, 2, 4), np.array([2.0, 0.0, 4.0, 1.0]), Units()).draw(SIZE)
    bars = [np.ptp(one.rings[0][:, 1]) for one in parts(drawing, Areas)]
    assert bars == pytest.approx([bars[1] / 2, bars[1], bars[1] / 4])
    assert [word for word in drawing.words() if word in {"2", "0", "4", "1"}][-4:] == list("2041")


def test_a_line_lies_at_its_values_between_nothing_and_the_top():
    assert heights(line([0, 50, 100], 0, 1, 2, top=100.0)) == pytest.approx([0.0, 0.5, 1.0])


def test_days_lie_as_far_apart_as_they_are():
    (dots,) = parts(line([1, 1, 1], 0, 1, 5).draw(SIZE), Discs)
    gaps = np.diff(dots.places[:, 0])
    assert gaps[1] == pytest.approx(4 * gaps[0])


def test_over_a_long_break_a_line_is_only_dashed():
    drawn = [one for one in parts(line([1, 2, 3, 4], 0, 1, 9, 10).draw(SIZE), Strokes)
             if one.colour == colours.ROUTE]  # fmt: skip
    assert {one.dashed: len(one.lines) for one in drawn} == {True: 1, False: 2}


def test_the_band_is_the_interval_and_holds_the_line():
    drawing = line([5, 7], 0, 1, spread=2.0).draw(SIZE)
    (dots,), (band,) = parts(drawing, Discs), parts(drawing, Areas)
    ring = band.rings[0]
    for x, y in dots.places:
        edges = ring[np.isclose(ring[:, 0], x), 1]
        assert edges.min() < y < edges.max()
        assert edges.mean() == pytest.approx(y)


def test_one_day_alone_has_a_mark_and_an_interval():
    drawing = line([5], 0, spread=2.0).draw(SIZE)
    assert len(parts(drawing, Discs)) == 1
    assert [one for one in parts(drawing, Strokes) if one.colour == colours.BAR]


def test_a_line_begins_where_there_is_a_value_and_the_days_before_it_keep_their_room():
    drawing = line([np.nan, np.nan, 40, 60], 0, 1, 2, 3, top=100.0).draw(SIZE)
    whole = line([10, 20, 40, 60], 0, 1, 2, 3, top=100.0).draw(SIZE)
    (dots,), (every,) = parts(drawing, Discs), parts(whole, Discs)
    assert dots.places == pytest.approx(every.places[2:])
    (band,) = parts(drawing, Areas)
    assert len(band.rings[0]) == 4
    none = line([np.nan, np.nan], 0, 1, top=100.0).draw(SIZE)
    assert not parts(none, Discs)
    assert not parts(none, Areas)


def test_dots_of_a_long_season_do_not_run_together():
    few, many = (line([5] * n, *range(n)).draw(SIZE) for n in (40, 200))
    assert [len(dots.places) for dots in parts(few, Discs)] == [40]
    (dots,) = parts(many, Discs)
    assert len(dots.places) == 1
    apart = line([5] * 201, *range(100), 150, *range(200, 300)).draw(SIZE)
    (dots,) = parts(apart, Discs)
    assert len(dots.places) == 2


def test_nothing_at_all_still_has_axes():
    drawing = DayChart(days(0), np.zeros(1), Units()).draw(SIZE)
    assert {"0", "2026-11-02"} <= set(drawing.words())


@pytest.mark.parametrize("top", [1, 3, 7, 19, 83, 450, 12_000])
def test_the_ticks_are_round_few_and_reach_the_highest(top):
    drawing = DayChart(days(0, 1), np.array([0.0, top]), Units()).draw(SIZE)
    ticks = [float(one.text.replace(",", "")) for one in parts(drawing, Lettering)
             if one.anchor == "end"]  # fmt: skip
    assert ticks[0] == 0
    assert ticks[-1] >= top
    assert 2 <= len(ticks) <= 7
    assert all(tick == int(tick) for tick in ticks)


def test_dates_do_not_meet_however_long_the_season():
    drawing = line(np.ones(200), *range(200)).draw(SIZE)
    at = sorted(one.x for one in parts(drawing, Lettering) if one.text.startswith("2026")
                or one.text.startswith("2027"))  # fmt: skip
    assert len(at) >= 4
    assert np.diff(at).min() >= 18.0


def test_a_mark_stands_at_its_day_and_only_within_the_days_shown():
    chart = line([1, 2, 3], 0, 1, 2, marks=((days(1)[0], "treated"), (days(9)[0], "later")))
    drawing = chart.draw(SIZE)
    (dots,) = parts(drawing, Discs)
    (mark,) = [one for one in parts(drawing, Strokes) if one.colour == colours.ACCENT]
    assert mark.lines[0][0, 0] == pytest.approx(dots.places[1, 0])
    assert "treated" in drawing.words()
    assert "later" not in drawing.words()
