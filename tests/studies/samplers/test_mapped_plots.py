"""Samplers on mapped plots whose truth is known."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.samplers.mapped_plots import (
    FILES,
    SHARES,
    DatedMap,
    MapRow,
    correlation,
    found_at,
    plots_in,
    table,
    table_csv,
)


def mapped(*infested):
    states = np.zeros(200, np.bool_)
    states[list(infested)] = True
    return DatedMap("made up", Aisles.of(rectangle(10, 20)), states)


def test_naive_finds_what_stands_in_its_first_rows():
    finds, hours = found_at(mapped(0, 5, 19, 39, 100), Naive())
    assert finds == [2, 3, 4, 4]
    stops_h = np.array([10, 20, 40, 80]) * Robot().visit_s / 3600
    assert (np.array(hours) >= stops_h).all()
    assert (np.array(hours) < 1.2 * stops_h).all()


def test_where_all_are_infested_every_look_finds_one():
    rows = table([mapped(*range(200))])
    assert [row.who for row in rows] == ["adaptive", "dynamic", "tuned", "naive", "random"]
    assert all(row.per_look == [1.0] * len(SHARES) for row in rows)


def test_who_begins_at_every_corner_meets_a_corner_as_often_as_there_are_corners():
    corner = [row * 20 + k for row in range(2) for k in range(20)]
    naive = next(row for row in table([mapped(*corner)]) if row.who == "naive")
    assert naive.per_look[0] == pytest.approx(0.5)


def test_adaptive_stays_beside_what_it_found():
    block = [row * 20 + k for row in range(3, 7) for k in range(5, 12)]
    found = {row.who: row for row in table([mapped(*block)])}
    assert found["adaptive"].per_look[-1] > 1.5 * found["random"].per_look[-1]
    assert found["adaptive"].per_hour[-1] > found["naive"].per_hour[-1]


def test_a_heavy_infestation_without_a_pattern_is_swept():
    infested = np.random.default_rng(3).permutation(200)[:100]
    found = {row.who: row for row in table([mapped(*infested)])}
    hours = np.array(found["adaptive"].per_hour) / found["naive"].per_hour
    assert (hours > 0.97).all()


def test_a_heavy_infestation_in_clusters_is_swept_until_it_shows_that_it_is():
    half = [row * 20 + k for row in range(10) for k in range(20) if (row // 5 + k // 5) % 2]
    found = {row.who: row for row in table([mapped(*half)])}
    hours = np.array(found["adaptive"].per_hour) / found["naive"].per_hour
    assert hours.min() > 0.97
    assert hours[-1] > 1.1


def test_neighbours_of_a_chessboard_are_opposite_and_those_of_halves_alike():
    board = [k for k in range(200) if (k // 20 + k) % 2]
    assert correlation(mapped(*board)) == pytest.approx(-1.0)
    assert correlation(mapped(*range(100))) > 0.8


def test_plots_are_named_by_file_and_date_or_part(tmp_path):
    (tmp_path / FILES[0]).write_text("x,y,t,i\n1,1,1991,1\n2,1,1991,0\n1,1,1992,1\n2,1,1992,1\n")
    (tmp_path / FILES[2]).write_text("field\tquadrat\trow\tdisease\nF1\t1\t1\tY\nF2\t1\t1\tN\n")
    made = [(each.name, each.infested.tolist()) for each in plots_in(tmp_path)]
    assert made == [
        ("citrus_ctv_IVI3and4 1991", [True, False]),
        ("citrus_ctv_IVI3and4 1992", [True, True]),
        ("gumpertz F1", [True]),
        ("gumpertz F2", [False]),
    ]


def test_a_folder_without_maps_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="must hold one of"):
        plots_in(tmp_path)


def test_the_table_is_csv():
    shares, hours = [0.1, 0.25, 0.3, 1 / 3], [1.0, 2.0, 3.0, 4.5]
    rows = [
        MapRow("a map", 0.1, "naive", shares, hours),
        MapRow("a map", 0.1, "random", shares, []),
    ]
    head, line, random = table_csv(rows).splitlines()
    columns = [f"finds_per_{what}_at_{s}_pct" for what in ("look", "hour") for s in (5, 10, 20, 40)]
    assert head.split(",") == ["map", "neighbour_correlation", "sampler", *columns]
    assert line == "a map,0.100,naive,0.1000,0.2500,0.3000,0.3333,1.0000,2.0000,3.0000,4.5000"
    assert random == "a map,0.100,random,0.1000,0.2500,0.3000,0.3333,,,,"
