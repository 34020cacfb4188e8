"""What was advised for a day, in the log of a season."""

from fieldmon.monitoring.days.advised import advise
from tests.monitoring.seasons import BEGINS, on


def test_the_same_advice_for_a_day_is_logged_once_however_often_it_is_asked(season):
    before = season.log()
    for day, said in ((0, "Treat."), (0, "Treat."), (1, "Treat."), (0, "Look on."), (0, "Treat.")):
        advise(season, on(day), said, "Ben")
    new = season.log()[len(before) :]
    assert {one.kind for one in new} == {"advised"}
    assert [(one.what["date"], one.what["said"]) for one in new] == [
        (str(BEGINS), "Treat."), (str(on(1)), "Treat."), (str(BEGINS), "Look on."),
        (str(BEGINS), "Treat."),
    ]  # fmt: skip
