"""`fieldmon study weather`: a line for each shape of the weather."""

import pytest

from fieldmon.studies import weather_known


@pytest.mark.parametrize("pest", [[], ["--pest", "plum-pox-virus"]])
def test_each_shape_is_said_in_a_line(run, monkeypatch, pest):
    monkeypatch.setattr(weather_known, "_SIDE", 12)
    weather_known._aisles.cache_clear()
    command = ("study", "weather", "--seeds", "2", "--days", "2", "--shape", "steady wind")
    code, out, err, _ = run(*command, *pest)
    weather_known._aisles.cache_clear()
    assert code == 0, err
    assert out.startswith("steady wind ")
    assert "of mornings" in out
    assert err.startswith("pest: ") == bool(pest)
    for one in ("Warmth", "Wind"):
        assert (f"{one} changes nothing of this pest" in err) == bool(pest)


def test_an_unknown_shape_is_told(run):
    code, _, err, _ = run("study", "weather", "--shape", "hail")
    assert code != 0
    assert err.startswith("A shape of weather must be one of")


def test_a_season_that_ends_before_its_heat_wave_is_refused(run):
    """It was compared on days of the usual weather."""
    code, _, err, _ = run("study", "weather", "--seeds", "2", "--days", "5")
    assert code == 2
    assert "A season with a heat wave must have 6 days or more" in err
