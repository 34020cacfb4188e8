"""Settings of a season: as values and as JSON, and the days that are of it."""

import json
from dataclasses import replace
from datetime import date, time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.insects.spread import Spread
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.settings.settings import (
    MonitoringSettings,
    as_json,
    from_json,
    seconds,
    settings_from,
)
from fieldmon.pests.weather import DAY_S, HOUR_S, weather_of
from fieldmon.planning.members import TeamMember, Teamwork
from fieldmon.plot.robot import Robot, Viewpoints

BEGINS = date(2026, 4, 6)


@given(
    st.sampled_from(("adaptive", "naive", "dynamic", "random")),
    st.integers(0, 2**40),
    st.times(),
    st.floats(0.1, 24.0),
    st.floats(0.0, 1.0),
    st.booleans(),
)
def test_settings_come_back_from_json_as_they_were(sampler, seed, starts, hours, rate, treated):
    settings = MonitoringSettings(
        BEGINS,
        starts,
        Robot(hours=hours, viewpoints=Viewpoints(((20.0, 0.5), (60.0, 0.9)))),
        sampler,
        prior=PriorSettings(half_life_days=3.5),
        belief=BeliefSettings(Spread(rate, "one"), treated),
        seed=seed,
    )
    assert from_json(as_json(settings)) == settings


def test_another_sampler_goes_without_the_settings_of_the_one_before():
    settings = MonitoringSettings(BEGINS, sampler="bouncy", sampler_settings={"every": 3})
    with pytest.raises(SettingError, match="every"):
        replace(settings, sampler="adaptive")
    assert settings.with_sampler("adaptive") == MonitoringSettings(BEGINS, sampler="adaptive")
    assert settings.with_sampler("snake").decides().every == 1


def test_a_season_file_keeps_settings_under_the_names_that_it_always_had():
    assert sorted(as_json(MonitoringSettings(BEGINS))) == [
        *("beliefs", "prior", "robot", "sampler", "season", "team"),
    ]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("season", "{}"),
        ("season", "no json"),
        ("sampler", '{"name": "naive"}'),
        ("sampler", "[]"),
        ("robot", '{"viewpoints": {"steps": [[1, 2]], "longer": null}}'),
        ("beliefs", '{"spread": {"rate_per_day": 7}, "treated": true}'),
    ],
)
def test_settings_changed_by_hand_into_something_else_are_a_sentence(name, text):
    with pytest.raises(FileProblem, match="as fieldmon wrote them"):
        from_json(as_json(MonitoringSettings(BEGINS)) | {name: text})


@given(st.integers(0, 800))
def test_a_day_is_the_number_of_its_date_and_the_other_way_round(day):
    settings = MonitoringSettings(BEGINS)
    assert settings.day(settings.date(day)) == day


@pytest.mark.parametrize(
    ("on", "says"),
    [(date(2026, 4, 5), "began on 2026-04-06"), (date(2028, 6, 15), "lasts 800 days")],
)
def test_dates_outside_the_season_are_a_sentence(on, says):
    with pytest.raises(SettingError, match=says):
        MonitoringSettings(BEGINS).day(on)


def test_a_sampler_must_exist_and_look_equally_long_at_every_plant():
    two = Robot(viewpoints=Viewpoints(((20.0, 0.5), (60.0, 0.9))))
    for robot in (Robot(), two):
        with pytest.raises(SettingError, match="equally long"):
            MonitoringSettings(BEGINS, robot=robot, sampler="adaptive-looks")
        MonitoringSettings(BEGINS, robot=robot, sampler="adaptive")
    with pytest.raises(SettingError, match="must be one of"):
        MonitoringSettings(BEGINS, sampler="best")


def test_seconds_are_counted_from_midnight():
    assert seconds(time(6, 30, 5)) == 6 * 3600 + 30 * 60 + 5


def test_a_season_begun_before_finds_were_traced_goes_on_as_it_did():
    parts = as_json(MonitoringSettings(BEGINS))
    before = parts | {"beliefs": parts["beliefs"].replace(', "traces": true', "")}
    assert parts != before
    assert MonitoringSettings(BEGINS).belief.traces
    assert not from_json(before).belief.traces


def test_a_robot_that_turns_on_the_spot_is_kept_as_it_always_was():
    settings = MonitoringSettings(BEGINS, team=(TeamMember("a"), TeamMember("b")))
    parts = as_json(settings)
    assert "turning_radius_m" not in parts["robot"] + parts["team"]


def test_a_season_that_kept_no_time_of_a_stop_is_charged_as_it_was():
    parts = as_json(MonitoringSettings(BEGINS))
    thesis = Robot().with_times("thesis")
    robot = json.loads(as_json(MonitoringSettings(BEGINS, robot=thesis))["robot"])
    del robot["stop_s"]
    assert from_json(parts | {"robot": json.dumps(robot)}).robot == thesis


def test_a_pest_in_its_weather_is_laid_out_once_for_a_season():
    at = np.datetime64("2026-11-18", "s") + 86_400 * np.arange(2)
    weather = weather_of(at, DAY_S, temperature_c=np.array([20.0, 21.0]))
    chosen = MonitoringSettings(date(2026, 11, 18), pest=shipped_pest("thesis"), weather=weather)
    again = from_json(as_json(chosen))
    assert again.pest_in_weather() is from_json(as_json(chosen)).pest_in_weather()
    assert again.pest == chosen.pest
    assert MonitoringSettings(date(2026, 11, 18)).pest_in_weather() is None


def test_more_weather_than_a_season_can_carry_is_refused():
    at = np.datetime64("2000-01-01", "s") + 3_600 * np.arange(40_000)
    weather = weather_of(at, HOUR_S, temperature_c=np.full(40_000, 20.0))
    with pytest.raises(SettingError, match="36000 hours or days of weather at most"):
        MonitoringSettings(date(2026, 11, 18), pest=shipped_pest("thesis"), weather=weather)


@pytest.mark.parametrize("on", ["2026-04-31", None, np.datetime64("NaT"), 3])
def test_what_is_no_date_is_refused_in_a_sentence(on):
    with pytest.raises(SettingError, match=r"'on' of MonitoringSettings\.day must be a date"):
        MonitoringSettings(date(2026, 4, 6)).day(on)


places = st.none() | st.tuples(st.floats(-180.0, 180.0), st.floats(-85.0, 85.0))
robots = st.builds(
    Robot,
    speed_m_s=st.floats(0.1, 5.0),
    row_change_s=st.floats(0.0, 90.0),
    turn_180_s=st.floats(0.0, 90.0),
    stop_s=st.floats(0.0, 9.0),
    look_s=st.floats(1.0, 99.0),
    hours=st.floats(0.1, 24.0),
    viewpoints=st.sampled_from([Viewpoints(), Viewpoints(((20.0, 0.5), (60.0, 0.9)))]),
    detection=st.none() | st.floats(0.1, 1.0),
    returns=st.booleans(),
    width_m=st.just(1.0),
    length_m=st.none() | st.floats(1.0, 3.0),
    turning_radius_m=st.none() | st.floats(0.5, 5.0),
)


@given(
    st.lists(st.tuples(robots, places, st.floats(0.0, 80_000.0)), max_size=3),
    st.builds(
        Teamwork, st.booleans(), st.floats(0.0, 999.0), st.floats(0.0, 9.0), st.floats(0.0, 9.0)
    ),
    robots,
    st.none() | st.dates(BEGINS, date(2027, 1, 1)),
    st.tuples(st.sampled_from(["", "he"]), st.booleans()),
)
def test_a_team_a_harvest_and_a_language_come_back_too(members, teamwork, robot, harvest, others):
    language, traces = others
    settings = MonitoringSettings(
        BEGINS,
        robot=robot,
        team=tuple(TeamMember(f"robot {k}", *one) for k, one in enumerate(members)),
        teamwork=teamwork if members else Teamwork(),
        harvest=harvest,
        language=language,
        belief=BeliefSettings(traces=traces),
    )
    assert from_json(as_json(settings)) == settings


def test_a_season_has_its_days_from_the_first_to_the_last_and_a_harvest_among_them():
    settings = MonitoringSettings(BEGINS)
    assert [settings.day(settings.date(day)) for day in (0, 800)] == [0, 800]
    MonitoringSettings(BEGINS, harvest=BEGINS)
    with pytest.raises(SettingError, match="Harvest must not be before"):
        MonitoringSettings(BEGINS, harvest=date(2026, 4, 5))
    assert settings_from({"begins": "2026-04-06", "harvest": "2026-05-01", "seed": 3}) == (
        MonitoringSettings(BEGINS, harvest=date(2026, 5, 1), seed=3)
    )
    with pytest.raises(SettingError, match="A season's settings"):
        settings_from({"begins": BEGINS, "colour": "green"})


def test_what_a_caller_makes_of_settings_that_were_read_is_not_read_by_the_next():
    written = as_json(MonitoringSettings(date(2026, 4, 6), sampler="dynamic"))
    one, other = from_json(written), from_json(written)
    assert one == other
    one.sampler_settings["n"] = 5
    assert other.sampler_settings == from_json(written).sampler_settings == {}


MITE = replace(shipped_pest("spider-mite"), detection=0.6)
FIFTEEN_DAYS = weather_of(
    np.datetime64(BEGINS, "s") - DAY_S * np.arange(40, 0, -1), DAY_S,
    temperature_c=np.full(40, 22.5),
)  # fmt: skip


def test_a_season_is_as_its_pest_and_weather_have_it_and_without_them_as_it_was():
    alone = MonitoringSettings(BEGINS, team=(TeamMember("Ann", Robot(hours=2)),))
    named = replace(alone, pest=MITE, weather=FIFTEEN_DAYS)
    for made in (named.of_its_pest(), named.of_its_pest(alone)):
        assert [one.detects for one in (made.robot, made.team[0].robot)] == [0.6, 0.6]
        assert made.prior.half_life_days == 15
        assert made.of_its_pest() == made.of_its_pest(made) == made
    assert replace(made, pest=None).of_its_pest(made) == replace(alone, weather=FIFTEEN_DAYS)
    # of the same pest, who comes new sees as much, unless a detection is told
    ben, eve = TeamMember("Ben", Robot(hours=3)), TeamMember("Eve", Robot(detection=0.4))
    changed = replace(made, team=(ben, eve)).of_its_pest(made)
    assert [one.robot.detects for one in changed.team] == [0.6, 0.4]
    # another pest says nothing of its detection, as if it had been named first
    whitefly = shipped_pest("whitefly")
    later = replace(made, pest=whitefly).of_its_pest(made)
    assert later == replace(alone, pest=whitefly, weather=FIFTEEN_DAYS).of_its_pest()


def test_a_season_that_goes_by_none_of_its_pests_values_says_so_unless_they_were_chosen():
    early = MonitoringSettings(BEGINS, pest=MITE, weather=FIFTEEN_DAYS)
    (said,) = early.unlike_its_pest()
    assert "an inspection finds 60 % of what is there, not 84 %" in said
    assert "records count half after 15 days, not 14." in said
    told = Robot(detection=0.84)
    chosen = replace(early, robot=told, prior=PriorSettings(half_life_days=3.5))
    for fine in (early.of_its_pest(), chosen, replace(early, pest=None)):
        assert fine.unlike_its_pest() == ()
    (said,) = replace(early, robot=told).unlike_its_pest()
    assert "finds" not in said


def test_a_half_life_that_was_chosen_and_what_does_not_change_stay():
    chosen = MonitoringSettings(
        BEGINS, pest=MITE, weather=FIFTEEN_DAYS, prior=PriorSettings(half_life_days=3.5)
    )
    assert chosen.of_its_pest().prior.half_life_days == 3.5
    # a file of before keeps what it was begun with
    assert replace(chosen, starts=time(7)).of_its_pest(chosen).robot == chosen.robot
