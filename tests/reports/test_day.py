"""A day on one page: what it says, planned or worked."""

from dataclasses import replace
from datetime import datetime, time, timedelta

import numpy as np
import pytest

from fieldmon.compute.units import Units
from fieldmon.compute.wording import estimate
from fieldmon.infestation.inspections import CLEAN, FOUND, SKIPPED, Inspections
from fieldmon.monitoring import PlannedAndDone
from fieldmon.monitoring.treating.applications import Application
from fieldmon.planning.members import TeamMember, team_of
from fieldmon.plot.grid import plant_numbers
from fieldmon.plot.robot import Robot
from fieldmon.reports import words
from fieldmon.reports.content import (
    Illustration,
    KeyFigures,
    Listing,
    NoteLines,
    Paragraph,
    Table,
    TickList,
)
from fieldmon.reports.day import DayFacts, day_of_each, day_report, which
from fieldmon.reports.pdf import pdf_bytes
from fieldmon.reports.season import season_report
from fieldmon.reports.sentences import headline
from tests.monitoring.seasons import BEGINS, ROBOT, a_season, some_results
from tests.reports.reading import MM, one, opened, table, texts


@pytest.fixture(scope="module")
def ahead(worked, last):
    return DayFacts.of_season(worked, last + timedelta(days=1))


@pytest.fixture(scope="module")
def done(worked, last):
    return DayFacts.of_season(worked, last)


def figures(report):
    return {each.label: each for each in one(report, KeyFigures).figures}


def paragraphs(report):
    return [block.text for block in report.sheets[0].blocks if isinstance(block, Paragraph)]


def test_a_planned_day_says_what_to_do_first(worked, last, ahead, of_day):
    on = last + timedelta(days=1)
    plan = worked.plan(on, keep=False)
    assert paragraphs(of_day)[0] == headline(plan.route, str(on))
    shown = figures(of_day)
    assert shown["Plants to inspect"].value == f"{len(plan.route):,}"
    assert shown["Expected finds"].value == f"{plan.route.expected_finds:.1f}"
    assert shown["Drive"].value == Units().metres(plan.route.drive_m)
    assert shown["Hours"].note.startswith("06:00 to ")
    assert ahead.route.plant.tolist() == plan.route.plant.tolist()


def test_a_day_in_which_clocks_are_put_forward_shows_no_hour_that_is_none(ahead):
    late = replace(ahead, begins=datetime(2027, 3, 26, 1, 30), team=())
    said = figures(day_report(late, Units()))["Hours"].note
    assert late.route.end_s > 1800.0
    ends = datetime(2027, 3, 26, 2, 30) + timedelta(seconds=round(late.route.end_s))
    assert said.startswith(f"01:30 to {ends:%H:%M}")


def test_a_day_that_is_over_says_what_was_done(worked, last, done, of_worked_day):
    made = worked.history.on(worked.settings.day(last))
    found = np.unique(made.plant[made.result == FOUND])
    lead, *_ = paragraphs(of_worked_day)
    assert lead == (f"Worked on {last}: {len(made)} plants inspected, {len(found)} found infested.")
    assert figures(of_worked_day)["Found that day"].value == f"{len(found)}"
    assert done.route.plant.tolist() == made.plant.tolist()
    numbered = plant_numbers(worked.plot.grid, found)
    lines = [row[0] for row in table(of_worked_day, "Found that day, by row").rows]
    assert lines == [f"{line}" for line in np.unique(numbered.line)]


def test_the_map_of_a_day_draws_as_found_what_the_season_counts_as_found(worked):
    facts = DayFacts.of_season(worked, BEGINS)
    found = worked.history.states(0) == FOUND
    assert np.array_equal(facts.state == FOUND, found)
    recorded = (worked.history.recorded == FOUND) & ~found
    assert np.array_equal(facts.recorded, recorded)
    assert recorded.any()

    def legend(facts):
        *_, below = [
            block for block in day_report(facts, Units()).sheets[0].blocks
            if isinstance(block, Illustration)
        ]  # fmt: skip
        return below.draw((186.0, 8.0)).words()

    assert words.LEGEND_RECORDED in legend(facts)
    assert words.LEGEND_RECORDED not in legend(replace(facts, recorded=np.zeros_like(recorded)))


def test_plants_nobody_could_inspect_and_gone_ones_have_a_sign_where_there_are_any(tmp_path):
    season = a_season(tmp_path / "season.gpkg")

    def has_sign(report):
        blocks = [block for sheet in report.sheets for block in sheet.blocks]
        maps = [block for block in blocks if isinstance(block, Illustration)]
        return any(words.LEGEND_NOT_INSPECTED in one.draw((186.0, 60.0)).words() for one in maps)

    def reports():
        yield day_report(DayFacts.of_season(season, BEGINS), Units())
        yield season_report(season, BEGINS, Units())

    assert not any(map(has_sign, reports()))
    notes = np.array(["mud", "gone", "mud"], object)
    day, plants = np.datetime64(BEGINS), np.array([3, 5, 7])
    season.record(Inspections.of(plants, np.full(3, SKIPPED), day, notes=notes), "x")
    season.record(Inspections.of(plants[2:], np.array([FOUND]), day), "y")
    facts = DayFacts.of_season(season, BEGINS)
    assert np.flatnonzero(facts.passed).tolist() == [3, 5], "what was found is shown as found"
    assert all(map(has_sign, reports()))


def test_a_day_that_is_over_has_all_its_finds_on_paper_and_no_room_for_notes(done, ahead):
    found = np.arange(0, len(done.chance), 8)
    full = day_report(replace(done, found=found), Units())
    by_row = table(full, "Found that day, by row")
    (page,) = texts(pdf_bytes(full))
    assert all(row[1] in page for row in by_row.rows)
    kinds = [[type(block) for block in day_report(of, Units()).sheets[0].blocks]
             for of in (done, ahead)]  # fmt: skip
    assert [NoteLines in each for each in kinds] == [False, True]


def test_a_past_day_with_nothing_recorded_gives_no_orders(worked, last):
    day = BEGINS + timedelta(days=3)
    past = DayFacts.of_season(worked, day, last)
    assert len(past.route)
    said = day_report(past, Units())
    assert paragraphs(said)[0] == f"{day} is past, and no inspection of it was recorded."
    kinds = [type(block) for block in said.sheets[0].blocks]
    assert not {KeyFigures, TickList} & {*kinds}
    assert kinds.count(Table) == 1, "that of the settings"
    kept = day_report(replace(past, held=PlannedAndDone(5, 0, 0, 1.0)), Units())
    assert paragraphs(kept)[1] == "Stops planned: 5."
    assert not DayFacts.of_season(worked, day, day).missed, "somebody may still go"


def test_a_day_tells_what_was_treated(worked, last, done):
    day = BEGINS + timedelta(days=2)
    treated = day_report(DayFacts.of_season(worked, day, last), Units())
    n = f"{len(worked.plot.grid):,}"
    assert table(treated, "Treatments").rows == ((f"{day}", "Oil", n, "70 %", "not said"),)
    assert not done.treatments


def test_where_it_hides_a_day_tells_how_many_of_the_infested_can_be_seen(worked, last, ahead):
    def note(infested):
        made = day_report(replace(ahead, infested=infested), Units())
        return figures(made)["Expected finds"].note

    chance = worked.evening(last + timedelta(days=1))
    assert ahead.infested == pytest.approx(chance[ahead.route.plant].sum())
    seen = estimate(ahead.route.expected_visible)
    assert note(500.0) == f"of 500 infested, {seen} of them visible"
    assert note(None) == note(ahead.route.expected_visible) == f"of {seen} infested on the route"


def test_half_a_day_says_both_what_was_done_and_what_is_left(tmp_path):
    season = a_season(tmp_path / "half.gpkg")
    season.record(some_results(season, 6, found=[2]))
    facts = DayFacts.of_season(season, BEGINS)
    leads = paragraphs(day_report(facts, Units()))
    assert leads[0] == f"Worked on {BEGINS}: 6 plants inspected, 1 found infested."
    assert leads[1] == headline(facts.route, str(BEGINS))
    assert facts.begins.strftime("%H:%M") > "06:00"


def test_a_day_ahead_tells_which_plants_are_left_off_as_nobody_may_enter(tmp_path):
    season = a_season(tmp_path / "closed.gpkg")
    waits = Application("Oil", reentry_hours=24.0, ended=time(5))
    season.treat(BEGINS, 0.0, plants=season.plant_numbers.line == 3, application=waits)
    facts = DayFacts.of_season(season, BEGINS)
    said = paragraphs(day_report(facts, Units()))
    assert [one for one in said if one.startswith("Closed until 05:00 on 2026-04-07 after Oil")]
    assert not (season.plant_numbers.line[facts.route.plant] == 3).any()


def test_a_day_ahead_tells_how_many_plants_are_left_out_as_nobody_could_inspect_them(tmp_path):
    season = a_season(tmp_path / "skipped.gpkg")
    seen = Inspections.of(np.arange(3), np.full(3, SKIPPED), np.datetime64(BEGINS))
    season.record(seen)
    told = "Left out of this plan: 3 plants that nobody could inspect last time."
    for days, said in ((1, [told]), (2, [])):
        facts = DayFacts.of_season(season, BEGINS + timedelta(days=days))
        leads = paragraphs(day_report(facts, Units()))
        assert [one for one in leads if one.startswith("Left out")] == said


def test_making_a_report_keeps_nothing_in_the_season(tmp_path):
    season = a_season(tmp_path / "quiet.gpkg")
    before = season.revision
    DayFacts.of_season(season, BEGINS + timedelta(days=3))
    assert season.revision == before
    assert len(season.kept_route(BEGINS + timedelta(days=3))) == 0


def test_every_stop_stands_in_its_row_in_the_order_of_the_rows(ahead, of_day):
    numbered = plant_numbers(ahead.route.aisles.grid, ahead.route.plant)
    rows = table(of_day, "Stops by row, in order").rows
    assert sum(int(row[2]) for row in rows) == len(ahead.route)
    assert [row[0] for row in rows] == [f"{line}" for line in dict.fromkeys(numbered.line.tolist())]
    assert [row[1] for row in rows] == sorted(row[1] for row in rows)


def test_rows_without_a_number_of_their_own_are_shown_by_name(ahead):
    grid = ahead.route.aisles.grid
    called = np.arange(len(grid.line_number)) + 101
    names = np.array([f"{k}A" for k in called])
    odd = replace(grid, line_called=np.stack([called, called], axis=1), line_named=names)
    route = replace(ahead.route, aisles=replace(ahead.route.aisles, grid=odd))
    report = day_report(replace(ahead, route=route), Units())
    assert " in row" in paragraphs(report)[0]
    for rows in ([row[0] for row in table(report, "Stops by row, in order").rows],
                 [row[2] for row in one(report, TickList).rows]):  # fmt: skip
        assert rows
        assert all(row == f"{row[:3]} · {row[:3]}A" for row in rows)


def test_every_stop_is_on_the_list_to_tick(ahead, of_day):
    ticks = one(of_day, TickList).rows
    numbered = plant_numbers(ahead.route.aisles.grid, ahead.route.plant)
    assert [int(row[0]) for row in ticks] == list(range(1, len(ahead.route) + 1))
    assert [int(row[2]) for row in ticks] == numbered.line.tolist()
    assert [int(row[3]) for row in ticks] == numbered.number.tolist()
    assert {row[5] for row in ticks} == {"☐"}


def test_no_stop_has_a_chance_of_nothing_or_all(ahead):
    chance = np.resize([1e-6, 0.5, 1 - 1e-6], len(ahead.route))
    report = day_report(replace(ahead, route=replace(ahead.route, infested=chance)), Units())
    ticks = one(report, TickList)
    assert ticks.columns[4] == "chance"
    assert [row[4] for row in ticks.rows[:3]] == ["under 0.1 %", "50.0 %", "over 99.9 %"]


def test_after_the_work_every_stop_has_its_result_instead(of_worked_day, done):
    ticks = one(of_worked_day, TickList)
    assert ticks.columns[-1] == "result"
    found = {int(plant) for plant in done.found}
    said = [row[5] for row in ticks.rows]
    assert said == ["found" if plant in found else "clean" for plant in done.route.plant.tolist()]


def test_what_is_assumed_stands_under_the_figures(of_day):
    sheet = of_day.sheets[0].blocks
    under = sheet[[isinstance(block, KeyFigures) for block in sheet].index(True) + 1]
    assert under.text.startswith("Assumed, though nobody said so: ")
    assert "Spread to a neighbour, a night: 2 %" in under.text


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ([3, 4, 5, 9], "3–5, 9"),
        ([*range(1, 99, 2)], "49 between 1 and 97"),
        ([*range(1, 99)], "1–98"),
    ],
)
def test_plants_of_a_row_are_named_or_counted(numbers, said):
    assert which(numbers, 40) == said


def test_the_map_has_a_legend_and_says_in_words_what_it_shows(of_day, ahead):
    maps = [block for block in of_day.sheets[0].blocks if isinstance(block, Illustration)]
    assert len(maps) == 2
    least, most = maps[0].heights
    assert 0 < least <= most <= 190.0
    assert f"{len(ahead.route)} stops on the route" in maps[0].alt
    assert "50 %+" in maps[1].draw((186.0, 8.0)).words()


def test_a_day_without_a_route_or_a_season_has_a_page_too(ahead):
    settings = replace(ahead.settings, belief=None, guessed=("The rows were guessed.",))
    report = day_report(replace(ahead, settings=settings), Units(date_like="16.11.2026"))
    assert one(report, Listing).sentences == ("The rows were guessed.",)
    assert f"{report.on:%d.%m.%Y}" in report.title
    assert one(report, NoteLines)
    hours = dict(row[:2] for row in table(report, "Settings").rows)["Working hours"]
    assert hours == f"{ROBOT.hours:g}"


def test_the_fullest_day_stays_on_its_page(done):
    guessed = ("A sentence of an import that is long enough to need more than one line. " * 3,) * 3
    found = np.arange(0, len(done.chance), 3)
    full = replace(
        done, found=found, worked=False, settings=replace(done.settings, guessed=guessed)
    )
    data = pdf_bytes(day_report(full, Units()), "letter")
    lowest = []
    opened(data).pages[0].extract_text(
        visitor_text=lambda said, cm, tm, *_: lowest.append(cm[5] + tm[5]) if said.strip() else None
    )
    assert min(lowest) >= 12.0 * MM - 1
    (page,) = texts(data)
    assert "Notes" in page
    assert "Plants found are" in page


def test_the_report_of_a_day_that_is_over_says_what_was_chosen_then(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    season.plan(BEGINS)
    season.record(some_results(season, n=3))
    season.plan(BEGINS + timedelta(days=1))
    before, now = season.settings, Robot(hours=7.0, detection=0.5)
    season.change(replace(before, robot=now, starts=time(9)), before)
    facts = DayFacts.of_season(season, BEGINS)
    assert facts.worked
    assert facts.begins.time() == before.starts
    assert facts.settings.robot == before.robot
    ahead = DayFacts.of_season(season, BEGINS + timedelta(days=1))
    assert (ahead.settings.robot, ahead.begins.time()) == (now, time(9))


def test_a_worked_day_is_held_to_its_plan(done, of_worked_day):
    n = done.held.planned
    said = f"Stops planned: {n:,}; done: {n:,}; left out: 0; added: 0."
    assert said in paragraphs(of_worked_day)
    other = day_report(replace(done, held=PlannedAndDone(9, 5, 1, 2.0)), Units())
    said = "Stops planned: 9; done: 5; left out: 4; added: 1."
    assert said in paragraphs(other)
    assert len(paragraphs(day_report(replace(done, held=None), Units()))) == (
        len(paragraphs(other)) - 1
    )


def test_each_page_of_a_night_shift_says_which_shift_its_numbers_are_of(tmp_path):
    season = a_season(tmp_path / "s.gpkg", starts=time(23, 30))
    plants = season.plan(BEGINS).route.plant
    until = 23.5 * 3600 + np.arange(1, len(plants) + 1) * 1.4 * 3600 / len(plants)
    late = until >= 86400
    dates = np.datetime64(BEGINS) + late
    found = np.where(np.arange(len(plants)) == len(plants) - 1, FOUND, CLEAN)
    season.record(Inspections.of(plants, found, dates, second=until % 86400), "night")
    next_day, n, k = BEGINS + timedelta(days=1), len(plants), int(late.sum())
    season.plan(next_day)
    first, second = (
        paragraphs(day_report(DayFacts.of_season(season, on), Units())) for on in (BEGINS, next_day)
    )
    later = f"in the shift that began on 2026-04-06, {k} more plants were inspected, 1 found"
    held = f"Stops planned: {n}; done: {n}; left out: 0; added: 0."
    assert first[:3] == [
        f"Worked on 2026-04-06: {n - k} plants inspected, 0 found infested.",
        f"After midnight, {later} infested: dated 2026-04-07.",
        f"Of the shift that begins on 2026-04-06: {held}",
    ]
    assert second[:2] == [
        f"Worked on 2026-04-07: {k} plants inspected, 1 found infested.",
        f"{k} of them were inspected after midnight, in the shift that began on 2026-04-06.",
    ]
    assert second[2].startswith("Of the shift that begins on 2026-04-07: Stops planned: ")
    # what is left of a shift may begin after midnight: it is the page of the same day
    late_begin = datetime.combine(next_day, time(0, 40))
    left = replace(DayFacts.of_season(season, BEGINS), begins=late_begin)
    assert day_report(left, Units()).on == BEGINS
    # a plan whose shift has not begun was not worked
    (said,) = (one for one in said_of(season, next_day) if one.startswith("On 1 day planned and"))
    assert said.endswith(held)
    # hours are those of both shifts of one date, without the day between them
    again = np.setdiff1d(np.arange(len(season.plot.grid)), plants)[:10].astype(np.int32)
    second = 23.5 * 3600 + np.arange(1, 11) * 120.0
    on = np.datetime64(next_day)
    season.record(Inspections.of(again, np.zeros(10, np.int8), on, second=second), "next")
    over = DayFacts.of_season(season, next_day, next_day + timedelta(days=1))
    both = figures(day_report(over, Units()))["Hours"]
    least_h = (float(until[-1]) - 86400 + 1200) / 3600  # and the way back to the gate
    assert least_h <= float(both.value) <= least_h + 0.1
    assert not both.note


def said_of(season, on):
    """Return the paragraphs of a season's report."""
    sheets = season_report(season, on, Units()).sheets
    return [one.text for sheet in sheets for one in sheet.blocks if isinstance(one, Paragraph)]


def test_the_route_of_a_day_on_which_several_are_out_is_said_to_be_nobodys(done):
    alone = replace(done, worked=False, held=PlannedAndDone(9, 5, 1, 2.0))
    several = replace(alone, held=PlannedAndDone(9, 5, 1, 4.0, people=2))
    said = [words.DAY_OF_NOBODY in paragraphs(day_report(one, Units())) for one in (alone, several)]
    assert said == [False, True]


@pytest.fixture
def of_a_team(tmp_path):
    """Return a season of two robots and a scout, and the day on which two of them worked."""
    team = (TeamMember("R1", Robot(hours=1.0)), TeamMember("Ann", Robot(hours=0.5, look_s=20.0)))
    season = a_season(tmp_path / "s.gpkg", team=team)
    for plan, member in zip(season.plan_each(BEGINS), team, strict=True):
        plants = plan.route.plant
        clean = np.zeros(len(plants), np.int8)
        who = np.array([member.name] * len(plants), object)
        season.record(Inspections.of(plants, clean, np.datetime64(BEGINS), who=who), member.name)
    return season


def test_a_team_s_day_names_who_worked_and_how_and_says_no_times_that_nobody_drove(of_a_team):
    facts = DayFacts.of_season(of_a_team, BEGINS, BEGINS + timedelta(days=1))
    report = day_report(facts, Units())
    said = figures(report)
    assert (said["Team"].value, said["Team"].note) == ("2", "\u2068Ann\u2069, \u2068R1\u2069")
    assert not {"Hours", "Drive"} & {*said}
    stops = table(report, "Stops by row").rows
    assert {row[1] for row in stops} == {"–"}
    assert [int(row[0]) for row in stops] == sorted(int(row[0]) for row in stops)
    assert {row[1] for row in one(report, TickList).rows} == {"–"}
    rows = {row[0]: row[1] for row in table(report, "Settings").rows}
    assert rows["\u2068R1\u2069: hours, seconds at a plant"] == "1 h, 40 s"
    assert rows["\u2068Ann\u2069: hours, seconds at a plant"] == "0.5 h, 20 s"
    assert "Working hours" not in rows
    # below it each has a page, with hours and times
    each = DayFacts.each_of_season(of_a_team, BEGINS, BEGINS + timedelta(days=1))
    made = day_of_each(each, Units())
    assert [sheet.heading for sheet in made.sheets] == [
        "The day's work", "The day's work: \u2068R1\u2069", "The day's work: \u2068Ann\u2069",
    ]  # fmt: skip
    assert sum(facts.inspected for facts in each[1:]) == each[0].inspected == each[0].held.done
    for facts in each[1:]:
        alone = day_report(facts, Units())
        assert facts.held.done == facts.inspected == len(facts.results)
        assert "Hours" in figures(alone)
        assert "–" not in {row[1] for row in table(alone, "Stops by row, in order").rows}


def test_one_of_a_team_with_a_plan_and_no_results_has_a_page_that_says_what_is_left(tmp_path):
    season = a_season(tmp_path / "s.gpkg", team=team_of(2))
    first, idle = (plan.route.plant for plan in season.plan_each(BEGINS))
    done = Inspections.of(first, np.zeros(len(first), np.int8), np.datetime64(BEGINS))
    season.record(done, "f", "robot-1")
    each = DayFacts.each_of_season(season, BEGINS, BEGINS + timedelta(days=1))
    assert [facts.who for facts in each] == ["", "robot-1", "robot-2"]
    (said,) = [
        block.text
        for block in day_of_each(each, Units()).sheets[2].blocks
        if isinstance(block, Paragraph) and block.text.startswith("Stops planned")
    ]
    assert said == f"Stops planned: {len(idle)}; done: 0; left out: {len(idle)}; added: 0."


def test_a_day_of_several_without_a_team_is_nobodys_drive_and_counts_a_plant_once(tmp_path):
    season = a_season(tmp_path / "s.gpkg")
    plants = season.plan(BEGINS).route.plant[:6]
    for k, (who, own) in enumerate((("Ann", plants[:4]), ("ann", plants[4:]), ("Dan", plants[3:]))):
        clean, names = np.zeros(len(own), np.int8), np.full(len(own), who, object)
        at = np.full(len(own), 3600.0 * (7 + k))
        done = Inspections.of(own, clean, np.datetime64(BEGINS), who=names, second=at)
        season.record(done, f"{k}", who)
        if k == 1:
            alone = DayFacts.of_season(season, BEGINS, BEGINS + timedelta(days=1))
            assert alone.team == ()
    facts = DayFacts.of_season(season, BEGINS, BEGINS + timedelta(days=1))
    report = day_report(facts, Units())
    said = figures(report)
    assert said["Team"].value == "2"
    assert not {"Hours", "Drive"} & {*said}
    assert said["Plants inspected"].value == "6"
    assert "6 plants inspected" in paragraphs(report)[0]
    assert sum(int(row[2]) for row in table(report, words.STOPS_BY_ROW).rows) == 6
    assert facts.held.done == 6


def test_the_day_ahead_of_a_team_says_whose_route_it_is(of_a_team):
    report, other = (
        day_report(facts, Units())
        for facts in DayFacts.each_of_season(of_a_team, BEGINS + timedelta(days=1))
    )
    assert "The route is that of \u2068Ann\u2069; the others of the team" in " ".join(
        paragraphs(other)
    )
    leads = [block.text for block in report.sheets[0].blocks if isinstance(block, Paragraph)]
    assert "The route is that of \u2068R1\u2069; the others of the team have their own." in leads
    assert "Hours" in figures(report)


def test_a_plant_that_two_say_otherwise_of_is_named_with_who_says_what(done, ahead):
    assert done.otherwise == ()
    said = tuple(f"Row 3, plant {n}: found (Ann), clean (Ben)" for n in range(12))
    listed = one(day_report(replace(ahead, otherwise=said), Units()), Listing)
    assert (listed.title, listed.sentences[:10]) == (
        "Clean and found, of the same plant",
        said[:10],
    )
    assert listed.sentences[10:] == ("... and 2 more.",)
