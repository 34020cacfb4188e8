"""Every field of `Robot` and of a season's settings comes to each place that says or takes it.

What a place rightly has not is named here with the reason, so that a new field needs a line.
"""

import json
from dataclasses import fields, is_dataclass, replace
from datetime import date, time
from inspect import signature
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.cli.change import ChangeOptions, change
from fieldmon.cli.worker_options import OF_ROBOT, RobotOptions, TeamworkOptions, WorkerOptions
from fieldmon.compute.units import Units
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.ancestry.origins import N_ORIGINS
from fieldmon.infestation.earlier_season import Believed, EarlierSeason
from fieldmon.io.readers.pest_file import shipped_pest
from fieldmon.io.readers.team import SETTINGS, read_team
from fieldmon.monitoring import MonitoringSettings
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.settings.settings import as_json, from_json
from fieldmon.monitoring.settings.settings_words import changed, differences, taken_back
from fieldmon.pests.pest import Citation, Increase, Pest, Stage
from fieldmon.pests.weather import DAY_S, weather_of
from fieldmon.planning.members import TeamMember, Teamwork
from fieldmon.planning.team_bound import quickest_of
from fieldmon.plot.robot import SAID_IN, Robot, Viewpoints
from fieldmon.reports.settings_rows import WorkSettings, changed_rows, settings_blocks

BEGINS = date(2026, 4, 6)
WEATHER = weather_of(np.array([BEGINS], "M8[s]"), DAY_S, temperature_c=np.array([20.0]))
#: something else than `ROBOT` says in each of its fields
ROBOT = Robot(width_m=0.8)
OTHER_ROBOT = {
    "speed_m_s": 1.0,
    "row_change_s": 11.0,
    "turn_180_s": 3.0,
    "stop_s": 2.5,
    "look_s": 25.0,
    "hours": 4.0,
    "viewpoints": Viewpoints(((10.0, 0.4),), 0.5),
    "detection": 0.7,
    "returns": False,
    "width_m": 0.9,
    "length_m": 1.4,
    "turning_radius_m": 2.0,
    "on_foot": True,
}
#: something else than `SEASON` says in each of its
SEASON = MonitoringSettings(BEGINS, robot=ROBOT, sampler="bouncy")
OTHER = {
    "begins": date(2026, 4, 7),
    "starts": time(7),
    "robot": Robot(hours=4),
    "sampler": "naive",
    "sampler_settings": {"every": 3},
    "prior": replace(SEASON.prior, background_chance=0.05),
    "belief": replace(SEASON.belief, treated=False),
    "seed": 2,
    "team": (TeamMember("Ann"),),
    "teamwork": Teamwork(contact_s=600.0),
    "pest": shipped_pest("spider-mite"),
    "weather": WEATHER,
    "harvest": date(2026, 6, 1),
    "language": "he",
}
MEMBER = TeamMember("Ann", ROBOT)
OTHER_MEMBER = {"name": "Ben", "robot": Robot(), "gate": (35.1, 30.3), "starts_s": 900.0}
TEAM = replace(SEASON, team=(MEMBER,))


def season_of(robot):
    return replace(SEASON, robot=robot)


def team_of(member):
    return replace(SEASON, team=(member,))


def otherwise(made):
    """Yield each number and each yes or no of settings, with them otherwise in that alone."""
    for field in fields(made):
        value = getattr(made, field.name)
        if is_dataclass(value):
            for name, inner in otherwise(value):
                yield f"{field.name} {name}", replace(made, **{field.name: inner})
        elif isinstance(value, bool | float):
            other = not value if isinstance(value, bool) else 0.9 * value + 1e-4
            yield field.name, replace(made, **{field.name: other})


#: which field is otherwise -> settings before and after
CASES = (
    {name: (SEASON, replace(SEASON, **{name: other})) for name, other in OTHER.items()}
    | {"teamwork": (TEAM, replace(TEAM, teamwork=OTHER["teamwork"]))}
    | {f"prior {name}": (SEASON, replace(SEASON, prior=prior))
       for name, prior in otherwise(SEASON.prior)}
    | {f"belief {name}": (SEASON, replace(SEASON, belief=belief))
       for name, belief in otherwise(SEASON.belief)}
    | {f"teamwork {name}": (TEAM, replace(TEAM, teamwork=teamwork))
       for name, teamwork in otherwise(TEAM.teamwork)}
    | {f"robot {name}": (SEASON, season_of(replace(ROBOT, **{name: other})))
       for name, other in OTHER_ROBOT.items()}
    | {f"robot of a team {name}": (TEAM, replace(TEAM, robot=replace(ROBOT, **{name: other})))
       for name, other in OTHER_ROBOT.items()}
    | {f"member {name}": (TEAM, team_of(replace(MEMBER, **{name: other})))
       for name, other in OTHER_MEMBER.items()}
    | {f"member's robot {name}":
       (TEAM, team_of(replace(MEMBER, robot=replace(ROBOT, **{name: other}))))
       for name, other in OTHER_ROBOT.items()}
    # what is found of what is there stays: the words of it alone would not tell
    | {"detection as it is": (SEASON, season_of(replace(ROBOT, detection=ROBOT.detects))),
       "detection longer": (SEASON, season_of(replace(ROBOT, viewpoints=Viewpoints(longer=1.0)))),
       "a slow speed": (SEASON, season_of(replace(ROBOT, speed_m_s=ROBOT.speed_m_s + 1e-5))),
       "member's detection as it is":
       (TEAM, team_of(replace(MEMBER, robot=replace(ROBOT, detection=ROBOT.detects)))),
       "figures of a pest":
       (replace(SEASON, pest=OTHER["pest"]),
        replace(SEASON, pest=replace(OTHER["pest"], detection=0.31)))}
)  # fmt: skip


@pytest.mark.parametrize(
    ("of", "other"), [(ROBOT, OTHER_ROBOT), (SEASON, OTHER), (MEMBER, OTHER_MEMBER)]
)
def test_every_field_has_something_else_to_say(of, other):
    assert {*other} == {field.name for field in fields(of)}
    assert all(getattr(of, name) != value for name, value in other.items())


@pytest.mark.parametrize(("before", "after"), CASES.values(), ids=CASES)
def test_it_is_kept_in_a_season_s_file_and_told_in_its_log(before, after):
    written = as_json(after)
    assert as_json(from_json(written)) == written
    if after.weather is None:  # which is its own, however alike
        assert from_json(written) == after
    said = "; ".join(differences(as_json(before), written))
    assert said
    # in words, not by where it stands in the file
    assert "teamwork" not in said
    assert "team members" not in said


@pytest.mark.parametrize(("before", "after"), CASES.values(), ids=CASES)
def test_it_is_said_when_it_is_chosen_and_when_it_is_taken_back(before, after):
    assert changed(after, before)
    assert "it made no difference" not in taken_back(after, before)


def of_work(settings):
    """Return what a report says that a day of such settings went by."""
    return WorkSettings(
        settings.robot, settings.sampler, settings.prior, (4.0, 2.5), (), settings.belief,
        pest_in_weather=settings.pest_in_weather(), team=settings.team,
    )  # fmt: skip


NOT_IN_REPORTS = {
    "begins": "the days of a report say it",
    "starts": "the times of each stop say it",
    "sampler_settings": "a sampler is named; fieldmon status has the rest",
    "seed": "nobody works by it",
    "teamwork": "it says how routes are given out, not how anybody works on one",
    "weather": "of no effect, and not said, without a pest",
    "harvest": "it stands with the treatments",
    "language": "the report is in it",
}


@pytest.mark.parametrize("name", OTHER)
def test_a_report_says_by_which_settings_a_day_went(name):
    before, after = ([*settings_blocks(of_work(one), Units())] for one in CASES[name])
    assert (before == after) == (name in NOT_IN_REPORTS)


@pytest.mark.parametrize("name", OTHER_ROBOT)
def test_a_report_says_by_which_robot_a_day_went_and_what_changed_meanwhile(name):
    before, after = (of_work(one) for one in CASES[f"robot {name}"])
    blocks = [[*settings_blocks(one, Units())] for one in (before, after)]
    assert blocks[0] != blocks[1]
    assert changed_rows(before, after, Units())
    assert changed_rows(after, before, Units())


NO_OPTION = {
    "viewpoints": "a table, which a pest's file has",
    "detection": "a pest's file or a team's table says it",
    "stop_s": "--robot-times has it, with the others of a robot",
    "returns": "studies alone ask for a day that ends in the plot",
    "on_foot": "--scout says it, and the page of a season",
}


def test_commands_take_every_setting_of_a_robot():
    assert {*OF_ROBOT.values()} | {*NO_OPTION} == {*OTHER_ROBOT}
    assert {*OF_ROBOT} | {"robot_times"} == {field.name for field in fields(RobotOptions)}
    assert {*OF_ROBOT} <= {*signature(change).parameters}


@pytest.mark.parametrize(("option", "setting"), OF_ROBOT.items())
def test_what_a_command_is_told_of_a_robot_is_that_setting_and_no_other(option, setting):
    said = {option: OTHER_ROBOT[setting] * SAID_IN[setting].units}
    made = replace(ROBOT, **{setting: OTHER_ROBOT[setting]})
    wide = {} if option == "width" else {"width": ROBOT.width_m}
    assert WorkerOptions(**said, **wide).robot() == made
    told = ChangeOptions("season.gpkg", worker=RobotOptions(**said))
    assert told.of_worker
    assert told.changed(SEASON, None) == season_of(made)
    assert told.changed(TEAM, None) == replace(season_of(made), team=(replace(MEMBER, robot=made),))


#: what `fieldmon change` is told to change each setting, as in `OTHER`
SAID = {
    "starts": {"start": "07:00"},
    "robot": {"worker": RobotOptions(hours=4.0)},
    "sampler": {"sampler": "naive"},
    "sampler_settings": {"every": 3},
    "prior": {"background": 0.05},
    "belief": {"flag_only": True},
    "team": {"robots": "2"},
    "teamwork": {"teamwork": TeamworkOptions(contact=10.0)},
    "pest": {"pest_options": SimpleNamespace(pest="x", named=lambda: OTHER["pest"],
                                             met=lambda _: None)},
    "weather": {"pest_options": SimpleNamespace(pest=None, named=lambda: None,
                                                met=lambda _: WEATHER)},
    "harvest": {"harvest": "2026-06-01"},
    "language": {"language": "he"},
}  # fmt: skip
NOT_CHANGED = {
    "begins": "another season begins on another day",
    "seed": "of samplers that draw; nobody wants another draw",
}


@pytest.mark.parametrize("name", OTHER)
def test_a_season_s_settings_can_be_changed_by_a_command(name):
    assert (name in SAID) != (name in NOT_CHANGED)
    if name in NOT_CHANGED:
        return
    with_pest = replace(SEASON, pest=OTHER["pest"])
    before = {"weather": with_pest, "teamwork": TEAM}.get(name, SEASON)
    after = ChangeOptions("season.gpkg", **SAID[name]).changed(before, None)
    differ = [
        field.name
        for field in fields(after)
        if getattr(after, field.name) != getattr(before, field.name)
    ]
    assert differ == [name]


@pytest.mark.parametrize(
    ("option", "setting", "value"),
    [
        ("contact", "contact_s", 600.0),
        ("least_gain", "least_gain", 0.7),
        ("passing", "passing_m", 5),
    ],
)
def test_how_a_team_works_together_can_be_changed_one_by_one(option, setting, value):
    told = TeamworkOptions(**{option: value / 60 if option == "contact" else value})
    after = ChangeOptions("season.gpkg", teamwork=told).changed(TEAM, None)
    assert after == replace(TEAM, teamwork=replace(TEAM.teamwork, **{setting: value}))
    with pytest.raises(SettingError, match="goes with a team, but here one works alone"):
        ChangeOptions("season.gpkg", teamwork=told).changed(SEASON, None)


NOT_IN_TABLES = {
    "viewpoints": NO_OPTION["viewpoints"],
    "returns": NO_OPTION["returns"],
    "on_foot": "the column who says it",
}


def test_a_team_s_table_has_every_setting_of_a_robot(tmp_path):
    assert {*SETTINGS.values()} | {*NOT_IN_TABLES} == {*OTHER_ROBOT}
    line = [str(OTHER_ROBOT[name] * SAID_IN[name].units) for name in SETTINGS.values()]
    path = tmp_path / "team.csv"
    path.write_text(f"name,{','.join(SETTINGS)}\nAnn,{','.join(line)}\n")
    (ann,) = read_team(path)
    told = {name: value for name, value in OTHER_ROBOT.items() if name not in NOT_IN_TABLES}
    assert ann.settings == pytest.approx(told)


NOT_OF_WAYS = {
    "hours": "those of all are added",
    "viewpoints": "the values of plants hold it, as detection",
    "detection": "the values of plants hold it",
    "returns": "all come back where one robot has the hours of all",
    "width_m": "the ways of its aisles hold it",
    "length_m": "likewise",
    "turning_radius_m": "likewise",
    "on_foot": "nobody is charged for it",
}


@pytest.mark.parametrize("name", OTHER_ROBOT)
def test_what_bounds_a_team_is_as_quick_as_the_best_of_it_in_every_setting(name):
    """Whichever is named first: else what a member can do beyond the first would be no bound."""
    other = replace(ROBOT, **{name: OTHER_ROBOT[name]})
    alike = quickest_of([ROBOT, other]) == quickest_of([other, ROBOT])
    assert alike == (name not in NOT_OF_WAYS)


EARLIER = EarlierSeason(
    "West", BEGINS, Believed("mite", 0.1, 0.8, 3.0, 1.0), (1.0,) * N_ORIGINS, (1.0,) * N_ORIGINS,
    (1.0,) * 4,
)  # fmt: skip
#: settings that say something of everything
WHOLE = replace(
    SEASON, team=(replace(MEMBER, robot=replace(ROBOT, turning_radius_m=2.0, on_foot=True)),),
    robot=replace(ROBOT, turning_radius_m=2.0, on_foot=True),
    belief=replace(SEASON.belief, earlier=EARLIER),
    pest=Pest(
        "own", stages=(Stage("egg", 10.0, 100.0),), generation=Stage("all", 10.0, 200.0),
        increase=Increase((10.0, 20.0), (0.1, 0.2)), viewpoints=Viewpoints(),
        citations=(Citation("movement", "a book"),),
    ),
    weather=WEATHER, harvest=OTHER["harvest"], language="he",
)  # fmt: skip


def within(plain, path=""):
    """Yield the path of each setting that a season's file names, and what it is of."""
    for name, value in plain.items():
        yield f"{path}{name}", plain
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, dict):
                yield from within(one, f"{path}{name} ")


def kept():
    """Return the parts of a season's settings, but for a year of hours."""
    return {name: json.loads(part) for name, part in as_json(WHOLE).items() if name != "weather"}


FORMATS = Path(__file__).parent / "monitoring" / "seasons_of_old"


def test_a_new_setting_raises_the_version_of_a_season_s_file():
    """An older fieldmon must not open what it would not understand."""
    names = [path for path, _ in within(kept())]
    known = (FORMATS / f"settings_of_format_{schema.VERSION}.txt").read_text().split("\n")[:-1]
    assert sorted({*names}) == known, (
        "Raise VERSION in fieldmon/monitoring/file/schema.py, and list the names of the new one."
    )


@pytest.mark.parametrize("path", sorted({p.rpartition(" ")[0] for p, _ in within(kept())}))
def test_a_setting_of_a_newer_fieldmon_is_said_and_not_taken_for_damage(path):
    parts = kept()
    if path == "":
        parts["colour"] = {"red": 3}
    else:
        next(of for at, of in within(parts) if at.rpartition(" ")[0] == path)["colour"] = 3
    unknown = f"know {path} colour." if path else "know colour."
    with pytest.raises(FileProblem) as problem:
        from_json({name: json.dumps(part) for name, part in parts.items()})
    said = str(problem.value)
    assert unknown in said
    assert "written by a newer fieldmon" in said
    assert "salvage" not in said


@pytest.mark.parametrize(
    ("name", "settings", "unknown"),
    [("cleverest", "{}", "sampler cleverest"), ("bouncy", '{"n": 3}', "sampler settings n")],
)
def test_a_sampler_of_a_newer_fieldmon_is_said(name, settings, unknown):
    newer = as_json(SEASON) | {"sampler": f'{{"name": "{name}", "settings": {settings}}}'}
    with pytest.raises(FileProblem, match=rf"know {unknown}\. .*newer fieldmon"):
        from_json(newer)
