"""`fieldmon status`: where a season stands."""

import re
from dataclasses import replace
from datetime import UTC, datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.cli.status import lines
from fieldmon.infestation.inspections import SKIPPED, Inspections
from fieldmon.infestation.plot_estimate import PlotEstimate
from fieldmon.monitoring import Season
from fieldmon.monitoring.estimates.last_days import default_date, last_date
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.local_clock import LocalClock, local_clock
from tests.cli.estate import BEGINS
from tests.monitoring.seasons import a_plot, a_season, all_on


def test_a_season_is_told_in_the_lines_of_its_status(run, season):
    code, out, err, _ = run("status", season, "--date", BEGINS)
    assert code == 0, err
    kept = Season(season)
    now = kept.status(last_date(kept))
    ahead = f"  forecast               {kept.forecast(now.on).sentence()}"
    assert out.splitlines() == [*lines(kept, now), ahead]
    assert "share found            not known: nothing was inspected yet" in out
    assert f"{now.plants:,} plants (0 %), 0 found infested" in out
    assert all(one.sentence() in out for one in now.learnt)
    assert "believed at first      An inspection finds 84 % of what is there" in out
    kept.record(Inspections.of(np.array([1]), np.array([0]), np.datetime64(BEGINS)), "x")
    later = run("status", season)[1]
    assert "learnt so far          An inspection finds " in later
    assert "share found                 0 % (0 % to 0 %) of found and not found yet" in later
    assert out.startswith(f"Nursery, {BEGINS} (day 1 of the season)")


def test_thousands_are_parted_in_every_number_of_a_status(season):
    kept = Season(season)
    now = kept.status(last_date(kept))
    many = {"plants": 12345, "inspected": 6543, "found": 2345, "finds": 3456}
    estimate = PlotEstimate(1207.6, 237, 3688, 0.0)
    said = "\n".join(lines(kept, replace(now, **many, infested=estimate)))
    assert "    1,208 (237 to 3,688 with" in said
    for clean, words in ((1e-5, "under 0.1 %"), (0.9999, "over 99.9 %"), (0.0, "   0.0 %")):
        each = replace(now, estimate=replace(now.estimate, chance_clean=clean))
        assert f"  chance it is clean     {words}" in lines(kept, each)
    assert " 6,543 of 12,345 plants (53 %), 2,345 found infested (3,456 finds: some again)" in said


def test_no_share_is_said_to_be_nothing_or_all_that_is_not(season):
    kept = Season(season)
    now = kept.status(last_date(kept))
    few = replace(now, plants=12345, inspected=1, found=1)
    few = replace(few, estimate=replace(now.estimate, expected=900.0, low=0, high=2000))
    said = "\n".join(lines(kept, few))
    assert "1 of 12,345 plants (0.0081 %)" in said
    assert "share found            under 1 % (under 1 % to 100 %) of found" in said


def test_plants_only_flagged_are_told_beside_those_not_found_and_what_is_assumed_of_rows(
    run, tmp_path
):
    file, taken = tmp_path / "flagged.gpkg", Assumed("row_bearing_deg", 72.31)
    plot = replace(a_plot(), assumed=(taken,))
    kept = a_season(file, plot, belief=BeliefSettings(treated=False))
    kept.record(
        Inspections.of(np.arange(20), np.ones(20, int), np.datetime64(kept.settings.begins)), "x"
    )
    out = run("status", file)[1]
    assert "are not found yet, and 20 were found and only flagged." in out
    assert "assumed of its rows    row bearing 72.3 degrees, along the longest side\n" in out
    # the forecast begins with as many
    still = re.search(r"still infested +(\d+) ", out)[1]
    assert int(still) > 20
    assert f"now {still};" in out
    words = ["--efficacy", "0.5", "--date", kept.settings.begins]
    treated = run("treat", file, *words)[1]
    assert "are not found yet, and 10 were found and only flagged." in treated


def test_planned_days_of_which_nothing_is_recorded_are_told_the_last_three(tmp_path, monkeypatch):
    kept = a_season(tmp_path / "s.gpkg")
    days = [kept.settings.begins + timedelta(days=k) for k in range(5)]
    all_on(monkeypatch, 0)
    for day in days:
        kept.plan(day)
    all_on(monkeypatch, 5)
    for n, day in enumerate(days[:2]):
        told = [one for one in lines(kept, kept.status(day)) if "not recorded" in one]
        assert told == [f"  planned, not recorded  {', '.join(map(str, days[: n + 1]))}"]
    said = "\n".join(lines(kept, kept.status(days[-1])))
    assert f"planned, not recorded  2 days and {days[2]}, {days[3]}, {days[4]}\n" in said


def test_contradictions_and_days_and_people_of_batches_are_told(run, season):
    """The day before's work is recorded late, by two people, and a third says otherwise."""
    kept, day = Season(season), np.datetime64(BEGINS)
    who = np.array(["Ann", "Dan"], object)
    results = Inspections.of(np.array([1, 2]), np.array([0, 1]), day, who=who)
    kept.record(results.take(slice(0, 1)), "robots")
    kept.record(results.take(slice(1, 2)), "robots", into=1)
    kept.record(Inspections.of(np.array([1]), np.array([1]), day), "x", "Noa", confirmed=True)
    _, out, _, _ = run("status", season, "--date", BEGINS, "--batches")
    row, plant = kept.plant_numbers.line[1], kept.plant_numbers.number[1]
    assert f"  contradiction          Row {row}, plant {plant}: clean (Ann), found (Noa)" in out
    assert "take back what is wrong with: fieldmon undo" in out
    assert f"    2 findings by Ann, Dan  robots  1 found, inspected {BEGINS}" in out
    assert f"    1 finding by Noa  x  row {row}, plant {plant}: found, inspected {BEGINS}" in out
    assert "contradiction" not in run("status", season, "--date", "2026-11-30")[1]


def test_rows_that_nobody_was_in_are_told(run, season):
    _, out, _, _ = run("status", season, "--date", BEGINS, "--rows")
    n_rows = Season(season).plot.grid.row_line.max() + 1
    assert sum(line.endswith("never") for line in out.splitlines()) == n_rows


@pytest.mark.parametrize(("ahead", "doubted"), [(0, False), (40, True)])
def test_a_day_recorded_that_has_not_come_is_doubted(run, season, ahead, doubted):
    kept = Season(season)
    today = max(local_clock(kept.plot.field).today(), kept.settings.begins)
    on = np.datetime64(today + timedelta(days=ahead))
    kept.record(Inspections.of(np.array([1]), np.array([1]), on), "typed in")
    code, out, err, _ = run("status", season)
    assert code == 0
    assert out.startswith(f"Nursery, {today} ")
    assert (f"the last day recorded, {on}, has not come" in err) == doubted
    assert (f"seen: {on} was recorded already, and it is {today}" in err) == doubted
    for mended in (f"correct {season} --who NAME --inspection 1 --date YYYY-MM-DD",
                   f"undo {season} --inspection 1\n"):  # fmt: skip
        assert (f"fieldmon {mended}" in err) == doubted


def test_a_find_of_a_first_day_that_has_not_come_is_doubted(run, season, monkeypatch):
    kept = Season(season)
    eve = datetime.combine(kept.settings.begins - timedelta(days=1), time(12), UTC)
    monkeypatch.setattr("fieldmon.plot.local_clock.utc_now", lambda: eve)
    assert "has not come" not in run("status", season)[2]
    on = np.datetime64(kept.settings.begins)
    kept.record(Inspections.of(np.array([1]), np.array([1]), on), "typed in")
    assert f"the last day recorded, {on}, has not come" in run("status", season)[2]


def test_a_day_ahead_that_was_only_planned_is_not_to_be_undone(run, season):
    kept = Season(season)
    today = max(local_clock(kept.plot.field).today(), kept.settings.begins)
    on = today + timedelta(days=40)
    kept.plan(on)
    code, out, err, _ = run("status", season)
    assert code == 0, err
    assert out.startswith(f"Nursery, {today} ")
    assert f"seen: {on} was planned already, and it is {today}" in err
    assert "fieldmon undo" not in err
    assert run("undo", season)[0] == 2
    assert "give --date" not in run("status", season, "--date", on)[2]


def test_records_of_before_are_said_with_their_days(tmp_path):
    kept = a_season(tmp_path / "s.gpkg")
    *_, spots, records = lines(kept, kept.status(last_date(kept)))
    assert spots.startswith("  hot spots ")
    assert records.strip() == kept.records_known().sentence()
    assert " 3 records of 2026-03-30 to 2026-04-02, 1 of them without a date." in records


def test_what_inspections_find_is_told_of_who_inspects_too(run, season):
    kept = Season(season)
    day = np.datetime64(BEGINS)
    kept.record(Inspections.of(np.arange(9), np.ones(9, int), day), "x")
    words = ["status", season, "--date", kept.settings.begins + timedelta(days=1)]
    assert "Inspections of that day" not in run(*words)[1]
    assert run("change", season, "--look", "20")[0] == 0
    now = Season(season)
    learnt = now.learnt(now.settings.begins, now.settings.robot.detects)
    (own,) = (one.value for one in learnt if one.name == "detection")
    assert f"Inspections of that day find {100 * own:.0f} %." in run(*words)[1]


def test_nothing_is_told_of_a_day_that_has_not_come_unless_it_is_asked_for(run, season):
    """Of a decision, a report and a record for a certifier, as of the status."""
    kept = Season(season)
    today = max(local_clock(kept.plot.field).today(), kept.settings.begins)
    kept.plan(today + timedelta(days=40))
    _, out, err, _ = run("decide", season, "--threshold", "5%")
    assert out.startswith(f"{today}, after the day's work.")
    assert f"this is of {today}. For another day give --date" in err
    for words in ([], ["--certification"]):
        _, _, err, (made,) = run("report", season, "-o", f"r{len(words)}.html", *words)
        assert f"this is of {today}. For another day give --until" in err
        assert f" to {today}" in made.read_text(encoding="utf-8")
        assert str(today + timedelta(days=40)) not in made.read_text(encoding="utf-8")


def test_a_season_all_of_which_lies_ahead_is_told_as_of_its_last_day(season, monkeypatch):
    kept = Season(season)
    ahead = kept.settings.begins + timedelta(days=2)
    kept.plan(ahead)
    for before, meant in ((1, ahead), (-1, ahead - timedelta(days=1)), (-9, ahead)):
        today = kept.settings.begins - timedelta(days=before)
        monkeypatch.setattr(LocalClock, "today", lambda _, today=today: today)
        assert default_date(kept) == meant


def test_plants_that_are_gone_by_a_note_of_before_are_said_to_count_so(tmp_path):
    kept = a_season(tmp_path / "s.gpkg")
    begins = kept.settings.begins
    notes = np.array(["gone: burnt", "tree is dead", "thorns"], object)
    skipped = np.full(3, SKIPPED)
    kept.record(Inspections.of(np.array([3, 4, 5]), skipped, begins, notes=notes), "x")
    told = list(lines(kept, kept.status(begins)))
    (at,) = (k for k, one in enumerate(told) if one.startswith("  gone "))
    assert (
        told[at]
        == "  gone                        2 do not stand there any more: plans leave them out"
    )
    assert told[at + 1].strip() == (
        "Of these, 1 is gone by a note alone ('tree is dead'), which counted as skipped before "
        "version 0.2. If it still stands, inspect it again."
    )
    kept.record(Inspections.of(np.array([4]), np.array([0]), begins + timedelta(days=1)), "y")
    told = list(lines(kept, kept.status(begins + timedelta(days=1))))
    assert "1 does not stand there any more" in "\n".join(told)
    assert not any("note alone" in one for one in told)


def test_plants_that_could_not_be_inspected_are_counted_with_those_left_out(tmp_path):
    kept = a_season(tmp_path / "s.gpkg")
    begins = kept.settings.begins
    assert not any("could not" in one for one in lines(kept, kept.status(begins)))
    for days, plants in ((0, [3, 4, 5]), (2, [4, 6])):
        skipped = np.full(len(plants), SKIPPED)
        kept.record(Inspections.of(np.array(plants), skipped, begins + timedelta(days=days)), "x")
    for days, left_out in enumerate([3, 0, 2, 1, 0]):
        now = kept.status(begins + timedelta(days=days))
        assert (now.skipped, now.left_out) == (3 if days < 2 else 4, left_out)
    (said,) = (one for one in lines(kept, kept.status(begins)) if "could not" in one)
    assert said == (
        "  could not be inspected      3 last time, 3 of them left out of the next day's plan"
    )
