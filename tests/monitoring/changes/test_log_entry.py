"""An entry of the log says what happened in a sentence."""

from dataclasses import replace

from fieldmon.compute.wording import estimate
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes.log_entry import LogEntry
from tests.monitoring.seasons import on, three_results


def test_what_a_program_records_without_a_name_is_logged_without_one(path):
    season = Season(path)
    season.record(three_results(5))
    assert season.log()[-1].sentence().startswith("0 found, 3 clean, 0 could not be inspected, ")


def test_the_log_speaks_of_one_thing_as_of_one():
    one = {"stops": 1, "labels": 1, "new": 1, "entries": 1, "source": "a.csv", "said": "x"}
    told = [
        LogEntry(1, "", kind, "", one, "").sentence() for kind in ("planned", "labels", "merged")
    ]
    assert told == [
        "?: 1 stop by ?, about ? of them visibly infested",
        "1 label from a.csv",
        "another copy of the season taken in: 1 inspection, 1 entry",
    ]


def test_what_was_planned_is_told_as_the_plan_told_it(path):
    season = Season(path)
    for k in range(1, 6):
        route = season.plan(on(k)).route
        said = season.log()[-1].sentence()
        assert said.endswith(f"about {estimate(route.expected_visible)} of them visibly infested")
    # half a plant is not rounded twice
    entry = replace(season.log()[-1], what={**season.log()[-1].what, "expected": 14.509})
    assert "about 15 of them" in entry.sentence()


def test_a_change_of_settings_is_told_from_what_to_what(path):
    season = Season(path)
    first = season.settings
    season.change(replace(first, robot=first.robot.with_hours(6.0), sampler="naive"), first)
    season.undo_change()
    changed = [one.sentence() for one in season.log() if one.kind == "changed"]
    back = "sampler naive to adaptive; hours 6 to 1.5"
    assert changed == [
        "settings: sampler adaptive to naive; hours 1.5 to 6",
        f"settings, the last change taken back: {back}",
    ]
    of_old = {"names": "robot, sampler", "now": {}}
    assert LogEntry(1, "", "changed", "", of_old, "").sentence() == ("settings: robot, sampler")
