"""What people want of a day besides is kept with the season, and all who are out go by it."""

import numpy as np
import pytest

from fieldmon.errors import FileProblem
from fieldmon.infestation.inspections import Inspections
from fieldmon.monitoring import Season
from fieldmon.monitoring.changes.transactions import set_meta
from fieldmon.monitoring.days.day_ahead import WorkPart, plan_ahead, planned_again, route_ahead
from fieldmon.monitoring.days.estate_day import EstatePlot
from fieldmon.monitoring.days.kept_wishes import keep_wishes, wishes_kept
from fieldmon.monitoring.phones import scouts
from fieldmon.monitoring.phones.photos_asked import ask_photo
from fieldmon.planning.wishes import Wishes
from tests.monitoring.seasons import BEGINS, a_season, on

ANN, BEN, CAT = (WorkPart((1, 4), "Ann"), WorkPart((1, 4), "Ben"), WorkPart((5, 9), "Cat"))


@pytest.fixture
def season(tmp_path):
    made = a_season(tmp_path / "s.gpkg")
    for one in (ANN, BEN, CAT):
        scouts.let_in(made, one.name, one.rows)
    return made


def row(season, line):
    return tuple(np.flatnonzero(season.plant_numbers.line == line).tolist())


def test_they_are_those_of_one_day_in_every_program_that_opens_the_file(season):
    wishes = Wishes((3, 4), (7,))
    keep_wishes(season, BEGINS, wishes)
    assert wishes_kept(Season(season.path), BEGINS) == wishes
    assert wishes_kept(season, on(1)) == Wishes()
    before = season.revision
    keep_wishes(season, BEGINS, wishes)
    assert season.revision == before, "what is kept already is not written"
    keep_wishes(season, BEGINS, Wishes())
    assert wishes_kept(season, BEGINS) == Wishes()


def test_nobody_who_is_out_is_led_to_what_is_not_wanted_whether_out_before_or_after(season):
    for part in (ANN, BEN, CAT):
        assert np.isin(route_ahead(season, BEGINS, part).plant, row(season, 6)).any() == (
            part is CAT
        )
    out = row(season, 2) + row(season, 6)
    keep_wishes(season, BEGINS, Wishes(unwanted=out))
    for part in (ANN, BEN, CAT):
        for way in (route_ahead, planned_again):
            led = way(season, BEGINS, part).plant
            assert len(led)
            assert not np.isin(led, out).any()
    for plan in (season.plan(BEGINS, keep=False), plan_ahead(season, BEGINS)):
        assert not np.isin(plan.route.plant, out).any()
    open_to = season.plan(BEGINS, keep=False, wishes=Wishes())
    assert np.isin(open_to.route.plant, out).any(), "who says what they want gets that"


def test_what_is_wanted_besides_reaches_who_is_out_once(season):
    def ways():
        return [route_ahead(season, BEGINS, part).plant.tolist() for part in (ANN, BEN, CAT)]

    before = ways()
    missed = np.setdiff1d(row(season, 2), np.concatenate(before))[:3].tolist()
    for line in range(1, 10):
        if len(missed) < 3:
            missed = np.setdiff1d(row(season, line), np.concatenate(before))[:3].tolist()
    keep_wishes(season, BEGINS, Wishes(tuple(missed)))
    after = ways()
    assert {*missed} <= {*np.concatenate(after).tolist()}
    assert ways() == after
    # what is done is wanted no more, and a way that was planned since is not planned again
    season.record(Inspections.of(np.array(missed), np.zeros(3, np.int8), BEGINS), "f")
    assert not {*missed} & {*np.concatenate(ways()).tolist()}


def test_a_photo_is_not_asked_for_of_what_nobody_is_to_inspect(season):
    out = row(season, 6)
    ask_photo(season, out[0])
    assert out[0] in route_ahead(season, BEGINS, CAT).plant
    keep_wishes(season, BEGINS, Wishes(unwanted=out))
    assert out[0] not in planned_again(season, BEGINS, CAT).plant


def test_a_day_shared_with_other_plots_leaves_it_out_too(season):
    out = row(season, 6)
    keep_wishes(season, BEGINS, Wishes(unwanted=out))
    scene = EstatePlot.of(season, BEGINS).scene
    assert (scene.last_inspected[list(out)] == scene.day).all()


@pytest.mark.parametrize(
    "said",
    ["[[1],[2]", "[[1],[2]]", '[[1],["2"],0]', "[1,[2],0]", "[[],[-1],0]", "[[],[99999],0]", "7"],
)
def test_a_file_that_says_something_else_is_refused_in_a_sentence(season, said):
    with season.store.writing() as db:
        set_meta(db, f"wishes {BEGINS}", said)
    with pytest.raises(FileProblem, match="two lists of plants of this plot"):
        season.plan(BEGINS)
