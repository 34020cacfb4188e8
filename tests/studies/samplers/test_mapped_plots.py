"""Samplers on mapped plots whose truth is known."""

import csv

import numpy as np
import pytest

import fieldmon as fm
from fieldmon.errors import FileProblem, SettingError
from fieldmon.plot.layout import rectangle
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler_or_name
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.samplers.contenders import Added, added
from fieldmon.studies.samplers.mapped_plots import (
    FILES,
    SHARES,
    WHO,
    DatedMap,
    MapRow,
    correlation,
    found_at,
    plots_in,
    sentences,
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


def test_where_all_are_infested_every_inspection_finds_one():
    rows = table([mapped(*range(200))])
    assert [row.who for row in rows] == list(WHO)
    assert all(row.per_inspection == [1.0] * len(SHARES) for row in rows)


def test_a_sampler_that_is_added_is_in_table_and_sentences():
    rows = table([mapped(0, 5, 19, 39, 100)], added(["snake"], to=WHO))
    assert [row.who for row in rows][-2:] == ["snake", "random"]
    assert " of the finds per hour of snake: over 1.05 on " in sentences(rows)[-1]
    assert added(WHO, to=WHO) == ()


def test_who_begins_at_every_corner_meets_a_corner_as_often_as_there_are_corners():
    corner = [row * 20 + k for row in range(2) for k in range(20)]
    naive = next(row for row in table([mapped(*corner)]) if row.who == "naive")
    assert naive.per_inspection[0] == pytest.approx(0.5)


def test_adaptive_stays_beside_what_it_found():
    block = [row * 20 + k for row in range(3, 7) for k in range(5, 12)]
    found = {row.who: row for row in table([mapped(*block)])}
    assert found["adaptive"].per_inspection[-1] > 1.5 * found["random"].per_inspection[-1]
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
    dated = [f"{x},1,{t},{int(x <= t - 1990)}" for t in (1991, 1992) for x in range(1, 21)]
    parts = [f"F{k}\t{q}\t1\t{'NY'[q == k]}" for k in (1, 2) for q in range(1, 21)]
    both = [f"1,{p},{int(p == 3)},2,1,north,2025" for p in range(1, 21)]
    (tmp_path / FILES[0]).write_text("\n".join(["x,y,t,i", *dated]))
    (tmp_path / FILES[2]).write_text("\n".join(["field\tquadrat\trow\tdisease", *parts]))
    own = ["row,plant,infested,row_m,plant_m,plot,date", *both]
    (tmp_path / "vines.map.csv").write_text("\n".join(own))
    made = {each.name: np.flatnonzero(each.infested).tolist() for each in plots_in(tmp_path)}
    assert made == {
        "citrus_ctv_IVI3and4 1991": [0],
        "citrus_ctv_IVI3and4 1992": [0, 1],
        "gumpertz.pepper F1": [0],
        "gumpertz.pepper F2": [1],
        "vines north 2025": [2],
    }


def test_of_fewer_plants_than_twenty_a_twentieth_is_none(tmp_path):
    (tmp_path / FILES[3]).write_text("row\tcol\ty\n1\t1\t1\n1\t2\t0\n")
    with pytest.raises(FileProblem, match=r"20 plants or more.*has 2"):
        plots_in(tmp_path)


def test_what_adaptive_comes_to_is_said_whichever_way_it_falls():
    def row(name, who, per_hour):
        return MapRow(name, 0.1, who, [0.0] * 4, [0.0] * 3 + per_hour if per_hour else [])

    rows = [
        *(row("a", "adaptive", [9.0]), row("a", "naive", [10.0]), row("a", "random", [])),
        *(row("b", "adaptive", [15.0]), row("b", "naive", [10.0]), row("b", "random", [])),
        *(row("c", "adaptive", [0.0]), row("c", "naive", [0.0])),
    ]
    (said,) = sentences(rows)
    assert "0.90 (a) to 1.50 (b) of the finds per hour of a sweep (naive)" in said
    assert said.endswith(
        "over 1.05 on 1 of 3 maps, under 0.95 on 1; no ratio can be given on 1: a sweep (naive) "
        "finds nothing there."
    )
    (said,) = sentences(rows[-2:])
    assert said.endswith(
        "no ratio to a sweep (naive) can be given on any of 1 map: a sweep (naive) finds nothing "
        "there."
    )


def test_maps_of_one_name_are_all_counted():
    def row(who, per_hour):
        return MapRow("a", 0.1, who, [0.0] * 4, [per_hour] * 4)

    rows = [row("adaptive", 9.0), row("naive", 10.0), row("adaptive", 15.0), row("naive", 10.0)]
    (said,) = sentences(rows)
    assert "0.90 (a) to 1.50 (a)" in said
    assert said.endswith("over 1.05 on 1 of 2 maps, under 0.95 on 1.")


class StopsEarly(fm.Sampler):
    """Inspects so many plants, and no more."""

    def __init__(self, most):
        self.most = most

    def walk(self, scene, would_find):
        stops = Naive().walk(scene, would_find)
        left = max(self.most - np.count_nonzero(scene.last_inspected >= 0), 0)
        return fm.Stops(stops.plant[:left], stops.arrive_s[:left])


def test_who_stops_early_has_no_figures_from_there_on():
    finds, hours = found_at(mapped(0, 5, 19, 39, 100), sampler_or_name(StopsEarly(39)))
    assert (np.isnan(finds) == [False, False, True, True]).all()
    assert (np.isnan(hours) == [False, False, True, True]).all()
    assert finds[:2] == [2, 3]
    early = Added("Early", "Early", "of your own", lambda: sampler_or_name(StopsEarly(39)))
    rows = table([mapped(0, 5, 19, 39, 100)], [early])
    ratio, says = sentences(rows)[-2:]
    assert ratio.endswith("no ratio to Early can be given on any of 1 map: Early stopped before.")
    assert says.startswith("Early stopped before 40% of the plants on 1 of 1 map: its figures are")
    (line,) = (line for line in csv.reader(table_csv(rows).splitlines()) if line[2] == "Early")
    assert [bool(cell) for cell in line[3:]] == [True, True, False, False] * 2


def test_who_names_no_plant_is_refused_as_everywhere():
    with pytest.raises(SettingError, match=r"^StopsEarly must name plants to inspect"):
        found_at(mapped(0, 5), sampler_or_name(StopsEarly(0)))


def test_a_folder_without_maps_is_refused(tmp_path):
    with pytest.raises(FileProblem, match="must hold a map of plants, one of"):
        plots_in(tmp_path)


def test_the_table_is_csv():
    shares, hours = [0.1, 0.25, 0.3, 1 / 3], [1.0, 2.0, 3.0, 4.5]
    rows = [
        MapRow("a map", 0.1, "naive", shares, hours),
        MapRow("a map", 0.1, "random", shares, []),
    ]
    head, line, random = table_csv(rows).splitlines()
    columns = [
        f"finds_per_{what}_at_{share}_pct"
        for what in ("inspection", "hour")
        for share in (5, 10, 20, 40)
    ]
    assert head.split(",") == ["map", "neighbour_correlation", "sampler", *columns]
    assert line == "a map,0.100,naive,0.1000,0.2500,0.3000,0.3333,1.0000,2.0000,3.0000,4.5000"
    assert random == "a map,0.100,random,0.1000,0.2500,0.3000,0.3333,,,,"


def test_a_name_with_a_comma_stays_one_column():
    rows = [MapRow("north, old", 0.2, "adaptive", [0.1] * 4, [1.0] * 4)]
    head, line = csv.reader(table_csv(rows).splitlines())
    assert line[:3] == ["north, old", "0.200", "adaptive"]
    assert head[3] == "finds_per_inspection_at_5_pct"
    assert len(head) == len(line)


def test_plants_of_unknown_state_count_in_nothing(tmp_path):
    """Not in the share, the correlation, the finds or what is inspected, from whichever corner."""
    lines = ["row,plant,infested,row_m,plant_m"]
    for row in range(10):
        for plant in range(10):
            state = "NA" if plant in {3, 8} or row == 2 else str(int(plant < 3))
            lines.append(f"{row + 1},{plant + 1},{state},3,1.5")
    (tmp_path / "a.map.csv").write_text("\n".join(lines))
    (plot,) = plots_in(tmp_path)
    assert (len(plot.infested), plot.unknown) == (72, 28)
    assert plot.infested.mean() == 27 / 72
    pairs = [(a, b) for a, b in zip([0, 1, 4, 5, 6], [1, 2, 5, 6, 7], strict=True)] * 9
    along = [(float(a < 3), float(b < 3)) for a, b in pairs]
    across = [(float(k < 3), float(k < 3)) for k in (0, 1, 2, 4, 5, 6, 7, 9)] * 7
    state = np.array(along + across) - 27 / 72
    assert correlation(plot) == pytest.approx(state.prod(1).mean() / plot.infested.var())
    (naive,) = [row for row in table([plot]) if row.who == "naive"]
    walk = [plant for plant in range(10) if plant not in {3, 8}]
    order = [p < 3 for row in range(9) for p in (walk if row % 2 == 0 else walk[::-1])]
    back = [p < 3 for row in range(9) for p in (walk[::-1] if row % 2 == 0 else walk)]
    assert naive.per_inspection[-1] == (sum(order[:29]) + sum(back[:29])) / 2 / 29


def test_where_all_plants_are_alike_there_is_no_correlation():
    for infested in ((), range(200)):
        rows = table([mapped(*infested)])
        assert np.isnan(rows[0].correlation)
        assert table_csv(rows).splitlines()[1].startswith("made up,,adaptive,")
