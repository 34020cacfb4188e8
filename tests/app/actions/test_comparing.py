"""What can be compared."""

from tests.app.driving import go


def test_comparing_nothing_is_said_in_a_sentence(app):
    go(app, "compare")
    app.multiselect(key="strategy_samplers").set_value([]).run()
    assert not app.exception
    assert "Choose fewer" in app.warning[0].value


def numbers(app):
    """Return the boxes for how many are infested at first, and how much they spread a night."""
    first = {"share": None, "rate": None}
    return [next(one.value for one in app.number_input if one.key.startswith(f"{name} "))
            for name in first]  # fmt: skip


def test_a_simulated_season_begins_as_the_open_season_believes(season_app, season):
    now = season()
    share = 100 * now.evening(now.settings.begins).mean()
    rate = 100 * now.settings.belief.spread.rate_per_day
    for page in ("compare", "simulate"):
        go(season_app, page)
        assert numbers(season_app) == [round(share, 1), rate]
        assert any("as the season believes" in one.value for one in season_app.caption)
        season_app.number_input(key="n_days").set_value(2)


def test_without_a_season_a_simulated_season_begins_as_in_a_command(app):
    assert numbers(go(app, "compare")) == [2.0, 10.0]
