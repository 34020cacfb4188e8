"""A season on four pages: its figures are the season's."""

import shutil
from dataclasses import replace
from datetime import datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.compute.wording import estimate
from fieldmon.decisions.labels import ProductLabel
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import Inspections
from fieldmon.infestation.records import PRESENT
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.estimates.figures_of_day import progress, still_infested
from fieldmon.monitoring.estimates.plant_states import finds_apart
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.plot.grid import plant_numbers
from fieldmon.reports import season as season_module
from fieldmon.reports import sentences
from fieldmon.reports.content import Illustration, KeyFigures, Listing, Paragraph
from fieldmon.reports.season import season_report
from fieldmon.reports.sentences import hot_spot_meanings
from tests.monitoring.seasons import BEGINS, a_season, all_on, clock_on, some_results
from tests.reports.reading import one, table


def on_sheet(report, number, kind):
    return [block for block in report.sheets[number].blocks if isinstance(block, kind)]


def test_the_four_pages_have_their_subjects_in_order(of_season):
    assert [sheet.heading for sheet in of_season.sheets] == [
        "Where it stands", "How it went", "Hot spots and finds", "Records, treatments, settings",
    ]  # fmt: skip


def test_where_it_stands_is_the_season_s_status_with_its_intervals(of_season, worked, last):
    status = worked.status(last)
    shown = {each.label: each for each in one(of_season, KeyFigures).figures}
    left = status.estimate
    assert shown["Still infested"].value == estimate(left.expected)
    assert shown["Still infested"].note == f"{left.low} to {left.high} (90 %)"
    assert shown["Plants found"].value == f"{status.found}"
    assert shown["Share found"].value == f"{status.detection_pct:.0f} %"
    assert shown["Plants inspected"].value == f"{status.inspected:,}"
    assert shown["Hot spots"].value == f"{len(status.hot_spots)}"
    lead = on_sheet(of_season, 0, Paragraph)[0].text
    assert lead.startswith(f"About {estimate(left.expected)} plants are still infested")


def test_the_chance_that_it_is_clean_is_one_figure_and_plants_not_inspected_are_named(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    n = len(season.plot.grid)
    for day in range(9):
        if season.status(BEGINS).estimate.chance_clean >= 0.005:
            break
        on = np.datetime64(BEGINS)
        season.record(Inspections.of(np.arange(n), [0] * n, on, second=np.full(n, 60.0 * day)), "")
    later = BEGINS + timedelta(days=1)
    gone = Inspections.of([0, 1, 2], [2, 2, 2], np.datetime64(later), notes=["gone", "", ""])
    season.record(gone, "")
    report = season_report(season, later, Units())
    shown = {each.label: each for each in one(report, KeyFigures).figures}
    paragraphs = [str(each.text) for each in on_sheet(report, 0, Paragraph)]
    chance = shown["Chance it is clean"].value
    assert f"The plot is clean with a chance of {chance}." in paragraphs[0]
    assert (
        "2 plants could not be inspected last time. 1 plant is gone: plans leave it out."
        in paragraphs
    )


def test_the_share_found_lies_in_its_interval(of_season):
    (share,) = [
        each for each in one(of_season, KeyFigures).figures
        if each.label == "Share found"
    ]  # fmt: skip
    low, high = (float(part.strip(" %")) for part in share.note.removesuffix("(90 %)").split("to"))
    assert low <= float(share.value.strip(" %")) <= high


def test_every_day_with_work_has_its_line_the_newest_first(of_season, worked):
    rows = table(of_season, "Day by day").rows
    kept = worked.days()
    assert [row[0] for row in rows] == [str(one.on) for one in reversed(kept)]
    assert [int(row[1]) for row in rows] == [one.inspected_today for one in reversed(kept)]
    assert [int(row[2]) for row in rows] == [one.found_today for one in reversed(kept)]


def test_the_charts_show_finds_share_expected_and_inspected(of_season):
    charts = on_sheet(of_season, 1, Illustration)
    assert [chart.title for chart in charts] == [
        "Plants found a day",
        "Share found, of found and not found yet, % (line), and its 90 % interval",
        "Infested and not found yet, as expected (line), and its 90 % interval",
        "Plants inspected a day",
    ]  # fmt: skip
    assert "treated" in charts[1].draw((186.0, 40.0)).words()  # which makes the share rise
    assert "treated" in charts[2].draw((186.0, 40.0)).words()
    assert "treated" not in charts[0].draw((186.0, 40.0)).words()


def test_hot_spots_are_said_as_everywhere_and_every_find_stands_by_its_row(worked):
    untreated = BEGINS + timedelta(days=1)
    of_season, status = season_report(worked, untreated, Units()), worked.status(untreated)
    said = one(of_season, Listing, "Hot spots").sentences
    assert list(said) == hot_spot_meanings(
        worked.plot.grid, status.hot_spots, finds_apart(worked.history, status.day)
    )
    assert any("known from the records brought only" in one for one in said)
    told = "Chances and hot spots begin with 3 records of 2026-03-30 to 2026-04-02, 1 of them"
    assert any(one.text.startswith(told) for one in on_sheet(of_season, 2, Paragraph))
    found = np.flatnonzero(worked.history.states(status.day) == PRESENT)
    rows = (by_row := table(of_season, "Plants found infested, by row")).rows
    assert by_row.columns == ("row", "plants", "which")  # plants are counted, not finds
    assert sum(int(row[1]) for row in rows) == len(found) == status.found
    line = plant_numbers(worked.plot.grid, found).line
    assert [int(row[0]) for row in rows] == np.unique(line).tolist()


def test_records_treatments_and_what_is_assumed_stand_on_the_last_page(of_season, worked, last):
    rows = table(of_season, "What was recorded").rows
    *rows, brought = rows
    assert brought == (str(BEGINS), "records brought", "", "", f"{len(worked.records)}")
    assert [row[2] for row in rows] == [batch.source for batch in worked.batches()]
    assert {row[3] for row in rows if row[1] == "inspections"} == {"נועה"}
    # by the clock of the plot, in the chosen way of writing dates
    dotted = season_report(worked, last, Units(date_like="16.11.2026"))
    at = datetime.fromisoformat(worked.batches()[0].at).astimezone(ZoneInfo("Asia/Jerusalem"))
    assert table(dotted, "What was recorded").rows[0][0] == f"{at:%d.%m.%Y %H:%M}"
    (treated,) = table(of_season, "Treatments").rows
    on = str(BEGINS + timedelta(days=2))
    assert treated == (on, "Oil", f"{len(worked.plot.grid):,}", "70 %", "not said")
    settings = {row[0]: row[1:] for row in table(of_season, "Settings").rows}
    assert settings["Spread to a neighbour, a night"] == ("2 %", "assumed")
    assert settings["Working hours"] == ("1.5", "chosen")
    assert len(one(of_season, Listing, "How the numbers are meant").sentences) == 6


def test_what_two_copies_both_recorded_is_said_to_count_once(tmp_path):
    here = a_season(tmp_path / "season.gpkg")
    there = Season(shutil.copy(here.path, tmp_path / "other.gpkg"))
    results = some_results(here, n=4)
    here.record(results.take(slice(0, 3)), "ann.csv")
    there.record(results.take(slice(0, 2)), "both.csv")
    there.record(results.take(slice(2, 4)), "part.csv")
    for copy in (here, there):
        copy.treat(BEGINS, 0.5, product="Oil")
    here.merge(there)
    rows = table(season_report(here, BEGINS, Units()), "What was recorded").rows[:-1]
    assert [row[1:3] for row in rows] == [
        ("treatment, counts in another recording", "Oil"),
        ("treatment", "Oil"),
        ("inspections, of which 1 counts", "part.csv"),
        ("inspections, counts in another recording", "both.csv"),
        ("inspections", "ann.csv"),
    ]


def test_a_season_just_begun_has_four_pages_too(tmp_path):
    season = a_season(tmp_path / "new.gpkg")
    report = season_report(season, BEGINS, Units())
    assert len(report.sheets) == 4
    (brought,) = table(report, "What was recorded").rows
    assert brought[1] == "records brought"
    assert one(report, Listing, "Treatments").sentences == ("No treatment was noted.",)
    assert "No plant was found infested yet." in [
        block.text for block in on_sheet(report, 2, Paragraph)
    ]
    assert on_sheet(report, 0, Paragraph)[-1].text.startswith("Never inspected: ")
    charts = on_sheet(report, 1, Illustration)
    assert len(charts) == 3, "of no inspections no share found is known, and none is drawn"
    for chart in charts:
        assert chart.draw((186.0, 30.0)).parts


def test_up_to_an_earlier_day_nothing_later_is_counted(worked):
    until = BEGINS + timedelta(days=1)
    report = season_report(worked, until, Units())
    assert table(report, "Day by day").rows[0][0] == str(until)
    shown = {each.label: each.value for each in one(report, KeyFigures).figures}
    assert shown["Plants found"] == f"{progress(worked, until).found}"
    assert one(report, Listing, "Treatments").sentences == ("No treatment was noted.",)
    said = worked.contents([batch.number for batch in worked.batches()]).values()
    earlier = sum(of.first <= str(until) for of in said)
    assert 0 < earlier < len(said)
    assert len(table(report, "What was recorded").rows) == earlier + 1  # those brought


def test_a_day_before_the_season_is_refused(worked):
    with pytest.raises(SettingError, match="must be of this season"):
        season_report(worked, BEGINS - timedelta(days=1), Units())


def test_finds_of_one_plant_on_two_days_are_said_to_be_one_plant(tmp_path):
    season = a_season(tmp_path / "twice.gpkg")
    plants = np.array([5], np.int32)
    from fieldmon.infestation.inspections import Inspections

    for day in (0, 1):
        on = np.datetime64(BEGINS + timedelta(days=day), "D")
        season.record(Inspections.of(plants, np.array([1], np.int8), on))
    report = season_report(season, BEGINS + timedelta(days=1), Units())
    (found,) = [each for each in one(report, KeyFigures).figures if each.label == "Plants found"]
    assert (found.value, found.note) == ("1", "in 2 finds")


def test_flagged_plants_are_said_beside_those_still_infested(tmp_path):
    season = a_season(tmp_path / "flagged.gpkg", belief=BeliefSettings(treated=False))
    looked = Inspections.of(np.arange(20), np.ones(20, int), np.datetime64(BEGINS))
    season.record(looked, "finds")
    lead = on_sheet(season_report(season, BEGINS, Units()), 0, Paragraph)[0].text
    still = still_infested(season, BEGINS)
    assert lead.startswith(f"About {estimate(still.expected)} plants are still infested")
    assert "are not found yet, and 20 were found and only flagged." in lead
    assert still.expected == pytest.approx(season.forecast(BEGINS).expected[0])
    figures = {one.label: one for one in one(season_report(season, BEGINS, Units()),
                                             KeyFigures).figures}  # fmt: skip
    assert figures["Still infested"].value == estimate(still.expected)


def test_lists_that_are_too_long_begin_with_what_counts_and_say_how_much_is_missing(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    season.change(replace(season.settings, harvest=BEGINS + timedelta(days=20)), season.settings)
    season.keep_labels([ProductLabel("Sulfur", waiting_days=5)])
    for day in range(7):
        said = Application("Sulfur", waiting_days=3)
        season.treat(BEGINS + timedelta(days=day), 0.8, application=said)
    said = Application("Acarol", waiting_days=14)
    season.treat(BEGINS + timedelta(days=9), 0.8, application=said)
    report = season_report(season, BEGINS + timedelta(days=9), Units())
    beware = one(report, Listing, "To beware of").sentences
    assert beware[0].startswith("Harvest on 2026-04-26 is too soon after Acarol on 2026-04-15")
    assert (len(beware), beware[-1]) == (7, "... and 3 more.")


def test_another_detection_that_was_said_with_inspections_stands_below_them(tmp_path, monkeypatch):
    season = a_season(tmp_path / "s.gpkg")
    for day, detects in enumerate((0.3, 0.6)):
        plants, date = np.arange(3), np.datetime64(BEGINS + timedelta(days=day))
        told = np.full(3, detects)
        season.record(Inspections.of(plants, plants % 2, date, detects=told), "rex.csv", "Rex")

    def said(on):
        blocks = on_sheet(season_report(season, on, Units()), 3, Listing)
        return [one for block in blocks for one in block.sentences if "was said with" in one]

    (first,) = said(BEGINS)
    assert first == (
        "Rex, 2026-04-06: 3 inspections find 30 % of what is there, as was said with them; the "
        "season's own is 84 %."
    )
    assert len(said(BEGINS + timedelta(days=1))) == 2
    monkeypatch.setattr(season_module, "_MOST_OTHERWISE", 1)
    assert len(said(BEGINS + timedelta(days=1))) == 1


def test_what_no_page_has_room_for_is_counted(worked, last, monkeypatch):
    untreated = BEGINS + timedelta(days=1)
    spots = len(worked.status(untreated).hot_spots)
    monkeypatch.setattr(sentences, "_MOST_SPOTS", spots - 1)
    monkeypatch.setattr(season_module, "_MOST_EFFECTS", 0)
    report = season_report(worked, untreated, Units())
    assert "... and 1 more." in [block.text for block in on_sheet(report, 2, Paragraph)]
    report = season_report(worked, last, Units())
    assert "... and 1 earlier." in [
        said for block in on_sheet(report, 3, Listing) for said in block.sentences
    ]


def test_all_days_are_held_to_their_plans(of_season, worked):
    planned = sum(len(worked.kept_route(one.on)) for one in worked.days() if one.inspected_today)
    (said,) = on_sheet(of_season, 1, Paragraph)
    assert said.text == (
        f"On 5 days planned and worked: Stops planned: {planned:,}; done: {planned:,}; "
        "left out: 0; added: 0."
    )


def test_a_planned_day_of_which_nothing_is_recorded_is_told_beside_them(tmp_path, monkeypatch):
    season = a_season(tmp_path / "s.gpkg")
    all_on(monkeypatch, 0)
    season.plan(BEGINS)
    clock_on(monkeypatch, 4)
    report = season_report(season, BEGINS + timedelta(days=4), Units())
    (said,) = on_sheet(report, 1, Paragraph)
    assert said.text == f"Planned, and nothing recorded: {Units().day(BEGINS)}."


def test_a_period_goes_by_what_was_in_force_in_it_and_tells_of_a_change(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    first = season.settings
    season.record(some_results(season, 3))
    longer = replace(first, robot=first.robot.with_hours(3.0), sampler="naive")
    season.change(longer, first)
    season.record(some_results(season, 3, day=1))

    def told(day):
        report = season_report(season, BEGINS + timedelta(days=day), Units())
        hours = {row[0]: row[1] for row in table(report, "Settings").rows}["Working hours"]
        said = [one for one in on_sheet(report, 3, Listing) if one.title == "Changed meanwhile"]
        return hours, [sentence for one in said for sentence in one.sentences]

    assert told(0) == ("1.5", [])
    said = "From 2026-04-07 on: Who chooses the plants: Adaptive, then Naive; Working hours: 1.5, "
    assert told(1) == ("3", [f"{said}then 3."])
    season.undo_change()
    assert told(1) == ("3", [f"{said}then 3."])  # what counts now was not worked by yet
    hours, changes = told(2)
    assert hours == "1.5"
    assert changes[1:] == [
        (
            "From 2026-04-08 on: Who chooses the plants: Naive, then Adaptive; Working hours: 3, "
            "then 1.5."
        )
    ]


def test_the_maps_show_as_many_plants_found_as_the_figures_say(worked, last):
    assert (worked.history.known(5) != worked.history.states(5)).any()  # records of before
    report, found = season_report(worked, last, Units()), worked.status(last).found
    maps = [block.alt for sheet in report.sheets for block in sheet.blocks
            if isinstance(block, Illustration) and "plants found." in block.alt]  # fmt: skip
    assert len(maps) == 2
    assert all(one.endswith(f" {found} plants found.") for one in maps)
