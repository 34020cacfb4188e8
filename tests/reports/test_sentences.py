"""A day and its hot spots in words: what to do, where they are and how surprising."""

from types import SimpleNamespace

import numpy as np
import pytest

from fieldmon.compute.wording import estimate, hours_figure
from fieldmon.plot.grid import plant_at
from fieldmon.plot.layout import rectangle
from fieldmon.reports.sentences import headline
from fieldmon.reports.sentences import hot_spot_meanings as meanings
from tests.io.writers.handed import empty, usual, with_names

GRID = rectangle(8, 30)


class Spots(SimpleNamespace):
    def __len__(self):
        return len(self.found)


def spots(*groups, p=0.01):
    of_plant = np.full(len(GRID), -1)
    for k, plants in enumerate(groups):
        of_plant[plants] = k
    n = len(groups)
    return Spots(of_plant=of_plant, found=np.arange(3, 3 + n), inspected=np.full(n, 9),
                 plants=np.array([len(g) for g in groups]), expected=np.full(n, 1.25),
                 p=np.full(n, p))  # fmt: skip


def at(*places):
    return [plant_at(GRID, row, number) for row, number in places]


def test_no_hot_spot_is_said_too():
    assert meanings(GRID, spots()) == ["No hot spots: finds cluster no more than chance allows."]


def test_rows_and_plants_are_those_of_its_corners():
    (said,) = meanings(GRID, spots(at((2, 7), (4, 3), (3, 9))))
    assert said.startswith("Rows 2 to 4, plants 3 to 9: 3 found among 9 inspected of its 3 plants")
    assert "1.2 would be" in said


def test_a_hot_spot_in_one_row_names_that_row():
    (said,) = meanings(GRID, spots(at((5, 2), (5, 4))))
    assert said.startswith("Row 5, plants 2 to 4:")


def test_finds_of_records_and_finds_treated_since_are_said_beside_those_that_count():
    of = spots(at((5, 2), (5, 4), (5, 6)), at((1, 1), (1, 2)))
    brought, treated = (np.isin(np.arange(len(GRID)), at(*some)) for some in (
        [(5, 2), (5, 4), (7, 7)], [(5, 6)],
    ))  # fmt: skip
    first, second = meanings(GRID, of, (brought, treated))
    assert first.endswith(
        "2 of them are known from the records brought only. "
        "1 more was found here and treated since."
    )
    assert second.endswith("about 1 in 100.")


def test_rows_without_a_number_of_their_own_are_said_by_name_behind_the_others():
    grid = with_names(rectangle(6, 9))
    for rows, said in (
        ((101,), "Row 101 · 5A, plants"),
        ((2, 101), "Rows 2 to 101 · 5A, plants"),
        ((1, 2, 101, 102), "Rows 1 to 2, 101 · 5A, 102 · =<Top> 7/8, plants"),
        ((101, 102), "Rows 101 · 5A to 102 · =<Top> 7/8, plants"),
    ):
        found = [plant_at(grid, row, 3) for row in rows]
        of_plant = np.full(len(grid), -1)
        of_plant[found] = 0
        one = spots(found)
        one.of_plant = of_plant
        assert meanings(grid, one)[0].startswith(said)


@pytest.mark.parametrize(
    ("p", "says"), [(0.04, "about 1 in 25."), (1e-5, "less than 1 in 10,000."), (0.9, "1 in 1.")]
)
def test_how_likely_it_is_by_chance_is_said_in_ones_of_many(p, says):
    (said,) = meanings(GRID, spots(at((1, 1), (1, 2)), p=p))
    assert said.endswith(says)


def test_of_very_many_only_the_first_are_said():
    assert len(meanings(GRID, spots(*([k] for k in range(12))))) == 8


def test_the_headline_says_plants_rows_hours_and_finds():
    route = usual().route
    lines = route.aisles.grid.row_line[route.aisles.grid.row[route.plant]] + 1
    assert headline(route, "2026-11-18") == (
        f"Inspect {len(route)} plants in rows {lines.min()}–{lines.max()} on 2026-11-18, "
        f"{hours_figure(route.end_s / 3600)} h: "
        f"about {estimate(route.expected_finds)} finds expected."
    )


def test_a_day_without_a_stop_is_said():
    assert headline(empty().route, "18.11.2026") == "Nothing to inspect on 18.11.2026."
