"""`fieldmon study weather`: a line for each shape of the weather."""

import pytest

from fieldmon.studies import weather_known


@pytest.mark.parametrize("pest", [[], ["--pest", "green-peach-aphid"]])
def test_each_shape_is_said_in_a_line(run, monkeypatch, pest):
    monkeypatch.setattr(weather_known, "_SIDE", 12)
    weather_known._aisles.cache_clear()
    command = ("study", "weather", "--seeds", "2", "--days", "2", "--shape", "cold week")
    code, out, err, _ = run(*command, *pest)
    weather_known._aisles.cache_clear()
    assert code == 0, err
    assert out.startswith("cold week ")
    assert "of mornings" in out
    assert err.startswith("pest: ") == bool(pest)


def test_an_unknown_shape_is_told(run):
    code, _, err, _ = run("study", "weather", "--shape", "hail")
    assert code != 0
    assert "A shape of weather must be one of" in err
