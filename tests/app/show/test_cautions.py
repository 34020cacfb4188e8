"""What to beware of after treatments is said in the page's words."""

from types import SimpleNamespace

import pytest

from app.show import cautions
from app.words import texts
from app.words.units import UnitsInLanguage
from tests.monitoring.seasons import BEGINS, a_season


class Shown:
    """Keeps what was shown instead of showing it."""

    def __init__(self):
        self.said = []

    def __getattr__(self, name):
        return lambda text: self.said.append((name, text))


@pytest.fixture
def shown(monkeypatch):
    kept = Shown()
    monkeypatch.setattr(cautions, "st", kept)
    return kept.said


def choices(season):
    units = UnitsInLanguage()
    return SimpleNamespace(season=season, on=BEGINS, units=units)


def test_nothing_is_shown_without_a_season_or_treatments(shown, tmp_path):
    cautions.show(choices(None))
    cautions.show_today(choices(None))
    season = a_season(tmp_path / "season.gpkg")
    cautions.show(choices(season))
    cautions.show_treatments(choices(season))
    assert shown == []
    season.treat(BEGINS, 0.5, product="soap")
    cautions.show_treatments(choices(season))
    assert ("markdown", f"**{texts.EFFECTS}**") in shown
    assert shown[-1] == ("caption", texts.EFFECTS_TREATED)
