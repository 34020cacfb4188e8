"""Hours shared between plots: no more than there are, nobody in two places, the urgent first."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fieldmon.errors import SettingError
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.planning.shared_day import PlotNeed, share_day
from fieldmon.plot.robot import Robot

needs = st.lists(
    st.builds(PlotNeed, st.floats(0, 1000), st.just(0.0) | st.floats(60, 200_000)),
    min_size=0,
    max_size=12,
)
hours = st.lists(st.floats(0.1, 12.0), min_size=1, max_size=4)


def crew(hours_each):
    return [TeamMember(f"m{k}", Robot(hours=h)) for k, h in enumerate(hours_each)]


@given(needs, hours, st.floats(0, 3600))
def test_nobody_works_longer_than_his_day_or_in_two_places_and_no_plot_twice(plots, each, move_s):
    members = crew(each)
    turns = share_day(plots, members, move_s)
    assert len({turn.plot for turn in turns}) == len(turns)
    for who, member in enumerate(members):
        own = [turn for turn in turns if turn.who == who]
        at = 0.0
        for turn in own:
            assert turn.starts_s >= at - 1e-6
            at = turn.starts_s + turn.seconds + move_s
        assert not own or at - move_s <= member.robot.day_s + 1e-6
    for turn in turns:
        assert turn.seconds <= plots[turn.plot].most_s + 1e-6


@given(needs, hours)
def test_of_one_mans_plots_more_is_expected_where_more_time_is_spent(plots, each):
    turns = share_day(plots, crew(each))
    for a in turns:
        for b in turns:
            if a.who == b.who and plots[a.plot].expected > plots[b.plot].expected:
                full = a.seconds >= plots[a.plot].most_s - 1e-6
                assert full or a.seconds >= b.seconds - 1e-6


def test_hours_are_shared_by_what_is_expected():
    plots = [PlotNeed(1, 1e6), PlotNeed(3, 1e6), PlotNeed(2, 1e6)]
    turns = share_day(plots, team_of(1, Robot(hours=6.5)), move_s=900)
    got = {turn.plot: turn.seconds / 3600 for turn in turns}
    assert got == pytest.approx({0: 1.0, 1: 3.0, 2: 2.0})
    assert [turn.plot for turn in turns] == [1, 2, 0], "the most urgent first"


def test_as_many_plots_as_members_are_one_each_and_too_many_members_stay_at_home():
    plots = [PlotNeed(5, 1e6), PlotNeed(50, 1e6)]
    turns = share_day(plots, team_of(3, Robot(hours=2)))
    assert sorted(turn.plot for turn in turns) == [0, 1]
    assert len({turn.who for turn in turns}) == 2
    assert {turn.seconds for turn in turns} == {7200.0}


def test_time_that_a_small_plot_does_not_need_goes_to_the_others():
    plots = [PlotNeed(10, 1800), PlotNeed(10, 1e6)]
    got = {turn.plot: turn.seconds for turn in share_day(plots, team_of(1, Robot(hours=4)), 0.0)}
    assert got == pytest.approx({0: 1800, 1: 4 * 3600 - 1800})


def test_a_plot_that_would_get_less_than_a_quarter_of_an_hour_waits():
    plots = [PlotNeed(100, 1e6), PlotNeed(1, 1e6)]
    assert [turn.plot for turn in share_day(plots, team_of(1, Robot(hours=4)))] == [0]


def test_nobody_goes_to_a_plot_where_there_is_nothing_to_inspect():
    plots = [PlotNeed(100, 0), PlotNeed(5, 1e6), PlotNeed(1, 0)]
    (turn,) = share_day(plots, team_of(1, Robot(hours=4)), move_s=900)
    assert (turn.plot, turn.starts_s, turn.seconds) == (1, 0, 4 * 3600)


def test_without_plots_or_members_there_is_no_turn():
    assert share_day([], team_of(2)) == ()
    assert share_day([PlotNeed(1, 100)], []) == ()


@pytest.mark.parametrize(("expected", "most_s"), [(-1, 5), (np.nan, 5), (1, -5)])
def test_needs_must_make_sense(expected, most_s):
    with pytest.raises(SettingError, match="0 or more infested"):
        PlotNeed(expected, most_s)


def test_going_to_the_next_plot_cannot_take_less_than_no_time():
    with pytest.raises(SettingError, match="must take 0 s or more"):
        share_day([], [], -1.0)


@given(
    st.lists(
        st.tuples(st.floats(0.1, 100), st.floats(60, 50_000)), min_size=1, max_size=6,
        unique_by=lambda need: need[0],
    ),
    hours,
    st.floats(0, 1800),
)  # fmt: skip
def test_plots_go_to_who_has_most_time_for_what_is_expected_and_get_it_by_one_level(
    plots, each, move_s
):
    """The urgent first; the least urgent wait where somebody would get under a quarter hour."""
    turns = share_day([PlotNeed(*one) for one in plots], crew(each), move_s)
    own = [[] for _ in each]
    for plot in sorted(range(len(plots)), key=lambda k: -plots[k][0]):
        left = [(3600 * hours - move_s * len(mine)) / (sum(plots[k][0] for k in mine)
                + plots[plot][0]) for hours, mine in zip(each, own, strict=True)]  # fmt: skip
        own[left.index(max(left))].append(plot)
    for who, mine in enumerate(own):
        got = {turn.plot: turn.seconds for turn in turns if turn.who == who}
        assert [turn.plot for turn in turns if turn.who == who] == mine[: len(got)]
        for n in range(len(mine), 0, -1):
            seconds = level_by_halving(
                [plots[k] for k in mine[:n]], 3600 * each[who] - move_s * (n - 1)
            )
            enough = [s >= min(plots[k][1], 900.0) for k, s in zip(mine, seconds, strict=False)]
            nearly = any(abs(s - min(plots[k][1], 900.0)) < 1e-3 and s < plots[k][1]
                         for k, s in zip(mine, seconds, strict=False))  # fmt: skip
            assume(not nearly)
            if n == 1 or all(enough):
                break
        expected = dict(zip(mine, seconds, strict=False)) if mine else {}
        assert got == pytest.approx(expected, rel=1e-6, abs=1e-6)


def level_by_halving(needs, seconds):
    """Return what each gets: so many seconds for each plant expected, but no more than its most."""
    low, high = 0.0, 1e9
    for _ in range(200):
        level = (low + high) / 2
        if sum(min(most_s, level * expected) for expected, most_s in needs) > seconds:
            high = level
        else:
            low = level
    return [min(most_s, high * expected) for expected, most_s in needs]


def test_to_a_second_who_has_most_time_for_a_plot_gets_it():
    """The first is as long at the second of two like plots as the other: half an hour."""
    for other_s, second in ((1799.7, 0), (1800.3, 1)):
        turns = share_day([PlotNeed(10, 1e6), PlotNeed(10, 1e6)], crew([1.0, other_s / 3600]), 0.0)
        assert [turn.who for turn in turns if turn.plot == 1] == [second]
