"""A driven day as tables and in words."""

import csv
import io
from datetime import date
from pathlib import Path

from fieldmon.drive.day import DrivenDay, DrivenStop
from fieldmon.drive.day_tables import day_table, in_words, is_driven_table, stop_table, stops_path
from fieldmon.drive.errand import Visit
from fieldmon.monitoring.estimates.asked_day import PlantToInspect

STOP = PlantToInspect(7, 2, 3, (0.0, 0.0), 10.0, 40.0, 0.84)
DAY = DrivenDay(
    [
        DrivenStop(STOP, Visit(True, 51.0, 0.04, frozenset({3, 9})), 50.0, 51.0),
        DrivenStop(STOP._replace(plant=8), Visit(None, 120.0, 0.12, stuck="Stuck."), 50.0, 69.0),
    ]
)


def read(data):
    return list(csv.DictReader(io.StringIO(data.decode())))


def test_the_day_is_one_line():
    (line,) = read(day_table(DAY, date(2026, 4, 6), "mujoco"))
    assert line == {
        "date": "2026-04-06",
        "robot": "mujoco",
        "stops": "2",
        "found": "1",
        "touched": "2",
        "stuck": "1",
        "charged_s": "100.0",
        "driven_s": "120.0",
        "worst_cross_track_m": "0.120",
        "skipped": "1",
        "stops_before": "0",
    }
    (line,) = read(day_table(DAY, date(2026, 4, 6), "mujoco", before=235))
    assert line["stops_before"] == "235"


def test_each_stop_is_a_line_beside_it():
    lines = read(stop_table(DAY))
    assert [line["found"] for line in lines] == ["1", ""]
    assert lines[0]["touched"] == "3 9"
    assert [line["stuck"] for line in lines] == ["0", "1"]
    assert stops_path(Path("a/day.csv")) == Path("a/day.stops.csv")


def test_the_day_in_words_says_what_went_wrong():
    said = in_words(DAY)
    assert "1 plant inspected, 1 found infested, 1 could not be inspected; charged" in said
    assert "+20.0 %" in said
    assert "2 plants touched; at worst 12 cm" in said
    assert said.endswith("Stuck.")
    assert "+0.0 %" in in_words(DrivenDay())
    assert "outline" not in said
    over = DrivenDay(home=Visit(None, over_m=0.124))
    assert "12 cm over the plot's boundary, or into a hole or a no-go area" in in_words(over)


def test_its_own_tables_are_known_from_sheets_to_fill_in(tmp_path):
    for name, data in (("day", day_table(DAY, date(2026, 4, 6), "x")), ("stops", stop_table(DAY))):
        (tmp_path / name).write_bytes(data)
        assert is_driven_table(tmp_path / name)
    (tmp_path / "sheet").write_bytes(b"\xef\xbb\xbforder,row,number,found\n1,1,1,yes\n")
    assert not is_driven_table(tmp_path / "sheet")
    assert not is_driven_table(tmp_path / "nothing")
