"""What imports say and ask, at a terminal."""

from dataclasses import replace
from datetime import date, datetime, time

import numpy as np
import pytest
import shapely

from fieldmon.cli.messages import (
    Terminal,
    describe,
    tell_assumed_of_plots,
    tell_clock_change,
    tell_past_midnight,
    tell_unusable,
)
from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.records import PRESENT, Records
from fieldmon.io.import_report import Remedy, guessed
from fieldmon.io.prepared_plots import Laid, SourceMessage
from fieldmon.monitoring.settings.settings import MonitoringSettings
from fieldmon.planning.members import team_of
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.field import Field
from fieldmon.plot.layout import rectangle
from fieldmon.plot.plot import Plot
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from tests.monitoring.seasons import a_plot

MONTH = guessed("Read day first.", "date", Remedy("date_order", "mdy", "Read month first"))


@pytest.mark.parametrize(
    ("role", "flag"), [("records", "--record-option"), ("plants", "--plants-option")]
)
def test_a_message_is_printed_with_the_option_that_answers(capsys, role, flag):
    Terminal().message(SourceMessage(role, "r.csv", MONTH))
    said = f"guessed: date: Read day first. (Read month first: {flag} date_order=mdy)\n"
    assert capsys.readouterr().err == said


def test_a_command_without_such_options_names_none(capsys):
    Terminal(flags={}).message(SourceMessage("records", "r.csv", MONTH))
    assert "(Read month first: date_order=mdy)" in capsys.readouterr().err


def test_a_plot_is_described_with_what_was_assumed_for_it(capsys):
    grid = rectangle(3, 4)
    field = Field("Gate", grid.frame.geometry_lonlat(grid.drivable_m))
    laid = Laid(Plot(field, Aisles.of(grid), (Assumed("row_spacing_m", 4.0),)))
    Terminal(takes_rows=False).laid(laid)
    assert capsys.readouterr().err == "guessed: row spacing 4 m\n"
    Terminal().laid(laid)
    out, err = capsys.readouterr()
    assert out.startswith("Gate: 12 plants in 3 rows, bearing 90.0 degrees, rows 4.00 m and")
    assert err == "guessed: row spacing 4 m [--row-spacing]\n"


def test_a_guessed_bearing_is_said_with_its_option_and_of_many_plots_once(capsys):
    Terminal().assumed([Assumed("row_bearing_deg", 86.42)])
    said = "row bearing 86.4 degrees, along the longest side"
    assert capsys.readouterr().err == f"guessed: {said} [--bearing]\n"
    tell_assumed_of_plots({"Gate": said})
    assert capsys.readouterr().err == f"assumed: {said}\n"
    tell_assumed_of_plots({"Gate": said, "Pond": said.replace("86", "12")})
    assert capsys.readouterr().err == "assumed: row bearing along the longest side of each\n"


def test_a_plot_of_one_plant_is_described_as_one_and_thousands_are_parted(capsys):
    grid = rectangle(100, 12)
    field = Field("Gate", grid.frame.geometry_lonlat(grid.drivable_m))
    describe(Plot.among("Tree", np.array([[35.1, 30.2]])))
    describe(Plot(field, Aisles.of(grid)))
    alone, many = capsys.readouterr().out.splitlines()
    assert alone == "Tree: 1 plant in no rows, visited by nearness."
    assert many.startswith("Gate: 1,200 plants in 100 rows, ")


def test_rows_are_counted_as_files_count_them_though_a_hole_cuts_some_in_two(capsys):
    plot = a_plot()
    assert plot.grid.n_rows > plot.grid.n_lines
    rows = len({*plot.to_geopandas()["row"]})
    describe(plot)
    assert f" in {rows} rows, bearing" in capsys.readouterr().out
    assert f" in {rows} rows>" in repr(plot)


@pytest.mark.parametrize(
    ("question", "flags", "how"),
    [
        (("", "feature", ("A", "B")), None, 'Which: --feature "A" or --feature 1.'),
        (("plot", "feature", ("A",)), None, 'Which. Answer with --feature "A", for instance.'),
        (("plot", "crs", ("EPSG:1",)), None, 'Which. Answer with --crs "EPSG:1", for instance.'),
        (
            ("plot", "where", ()),
            None,
            'Which. Answer with --plot-option where="...", for instance.',
        ),
        (
            ("records", "crs", ("EPSG:1",)),
            None,
            'Which. Answer with --record-option crs="EPSG:1", for instance.',
        ),
        (
            ("risk", "band", ("1",)),
            None,
            'Which. Answer with --risk-option band="1", for instance.',
        ),
        (
            ("records", "plot", ("A",)),
            None,
            'Which. Answer with --record-option plot="A", for instance.',
        ),
        (("records", "plot", ("A",)), {}, 'Which. Answer with --feature "A", for instance.'),
        (("plot", "feature", ("A",)), {}, 'Which. Answer with --feature "A", for instance.'),
        (("records", "crs", ("EPSG:1",)), {}, "Which."),
    ],
)
def test_a_question_is_asked_with_how_this_command_answers_it(question, flags, how):
    role, option, choices = question
    terminal = Terminal() if flags is None else Terminal(flags=flags)
    with pytest.raises(ChoiceNeeded) as raised, terminal.answering():
        raise ChoiceNeeded("Which.", option, choices, role)
    assert str(raised.value) == how
    assert (raised.value.option, raised.value.choices) == (option, choices)


def test_records_that_say_nothing_about_a_day_are_named(capsys):
    day = np.datetime64("2026-11-02")
    dates = np.array([day + 5, day - 1])
    records = Records.of(np.zeros((2, 2)), np.array([PRESENT, PRESENT]), dates)
    tell_unusable(records, day, PriorSettings())
    assert "1 of the records is of a later day" in capsys.readouterr().err
    tell_unusable(records.take(np.array([1])), day, PriorSettings())
    said = "seen: Chances and hot spots begin with 1 record of 2026-11-01.\n"
    assert capsys.readouterr().err == said
    tell_unusable(Records.none(), day, PriorSettings())
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("start", "hours", "said"), [(20, 4.0, False), (20, 4.5, True), (6, 12.0, False), (23, 2, True)]
)
def test_work_past_midnight_is_doubted(capsys, start, hours, said):
    on, starts = date(2026, 12, 31), time(start)
    tell_past_midnight(on, MonitoringSettings(on, robot=Robot(hours=hours), starts=starts))
    err = capsys.readouterr().err
    # as `record` dates them
    dated = "with a time after that is of 2027-01-01, one of a route without a time of 2026-12-31."
    assert (dated in err) == said == bool(err)


def test_clocks_put_back_in_a_seasons_work_are_told(capsys):
    field = Field("plot", shapely.MultiPolygon([shapely.box(35.15, 30.36, 35.151, 30.361)]))
    tell_clock_change(datetime(2026, 10, 25, 0, 30), 4, field)
    assert "put back by 60 min during this work" in capsys.readouterr().err
    for start in (datetime(2026, 10, 25, 6), datetime(2027, 3, 26, 1)):
        tell_clock_change(start, 4, field)
        assert capsys.readouterr().err == ""


def test_work_of_who_starts_late_in_a_team_goes_past_midnight(capsys):
    on, team = date(2026, 12, 31), team_of(2, Robot(hours=4.0))
    late = replace(team[1], starts_s=3600.0)
    tell_past_midnight(on, MonitoringSettings(on, team=(team[0], late), starts=time(20)))
    assert "past midnight, to 01:00" in capsys.readouterr().err
