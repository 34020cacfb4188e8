"""A person is written as the season did first, whoever types the name."""

from dataclasses import replace

import numpy as np
import pytest

from fieldmon.errors import AccessError
from fieldmon.monitoring import Application, Season
from fieldmon.monitoring.days.advised import advise
from fieldmon.monitoring.phones import scouts
from tests.monitoring.seasons import BEGINS, three_results


def test_a_person_is_written_as_at_first_whoever_types_it(path):
    season = Season(path)
    first = scouts.let_in(season, "Ann")
    second = scouts.let_in(season, "ann ")
    with pytest.raises(AccessError):
        scouts.key_owner(season, first)
    assert scouts.key_owner(season, second).name == "Ann"
    season.record(three_results(), "f", "ANN")
    theirs = np.array(["Ben", "BEN", "aNN"], object)
    season.record(replace(three_results(on=1), who=theirs), "g")
    assert season.history.inspections.who.tolist()[-6:] == ["Ann"] * 3 + ["Ben", "Ben", "Ann"]
    season.treat(BEGINS, 0.5, application=Application("soap", operator="aNN "))
    assert season.treat(BEGINS, 0.5, application=Application("soap", operator="ann")).new == 0
    (treated,) = season.treatments()
    assert (treated.application.operator, season.batches()[0].who) == ("Ann", "Ann")
    season.undo(who="ANN")
    season.undo(who="ben")
    season.change(replace(season.settings, sampler="naive"), season.settings, "aNN")
    season.undo_change("ben ")
    advise(season, BEGINS, "wait", "BEN")
    otherwise = replace(three_results(), result=np.array([0, 1, 1], np.int8), who=theirs)
    season.record_instead(otherwise, "h", "ANN")
    assert {*season.history.inspections.who.tolist()[-3:]} <= {"Ann", "Ben"}
    assert {entry.who for entry in season.log()[-6:]} == {"Ann", "Ben"}
    scouts.withdraw_key(season, "ANN")
    assert scouts.key_owner(season, scouts.let_in(season, "ben", (1, 2))).name == "Ben"


def test_a_name_with_a_comma_is_one(path):
    season = Season(path)
    scouts.let_in(season, "COHEN, Uri", (1, 2))
    scouts.let_in(season, "uri", (3, 4))
    assert (
        scouts.key_owner(season, scouts.let_in(season, "Cohen, uri", (1, 2))).name == "COHEN, Uri"
    )
    assert [one.name for one in scouts.scouts_of(season)] == ["uri", "COHEN, Uri"]
    season.record(three_results(), "f", "Levi, Dan")
    assert scouts.key_owner(season, scouts.let_in(season, "levi, dan", (5, 6))).name == "Levi, Dan"
