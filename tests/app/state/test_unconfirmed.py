"""Results wait for a word on the season that they were brought to."""

import pytest

from app.state import unconfirmed
from app.state.unconfirmed import Unconfirmed
from fieldmon.infestation.inspections import Inspections


@pytest.mark.usefixtures("session")
def test_results_wait_for_their_own_season_and_day_until_dropped():
    waiting = Unconfirmed("a.gpkg", "2026-11-16", Inspections.none(), "route.csv")
    unconfirmed.keep(waiting)
    assert unconfirmed.of("a.gpkg", "2026-11-16") is waiting
    assert unconfirmed.of("b.gpkg", "2026-11-16") is None
    assert unconfirmed.of("a.gpkg", "2026-11-17") is None
    unconfirmed.drop()
    assert unconfirmed.of("a.gpkg", "2026-11-16") is None
