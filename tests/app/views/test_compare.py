"""Strategies are compared while the page waits for nothing."""

from app.state import chosen_pest
from app.state.comparison import WatchedComparison
from tests.app.driving import go, press, texts_of, until


def compare(app):
    """Press Compare, and look now and then whether all is compared."""
    app.button(key="run").click().run()
    until(lambda: len(app.run().table) and app.button(key="run_stop").disabled, every_s=0.5)


def test_strategies_are_compared_and_the_best_is_put_to_use(app):
    go(app, "compare")
    app.number_input(key="seeds").set_value(3)
    app.number_input(key="n_days").set_value(4).run()
    assert "Assumed: insects spread to the plants next to them only" in texts_of(app)
    assert "press Compare" in texts_of(app)
    compare(app)
    assert not app.exception
    table, more = (one.value for one in app.table)
    assert len(table) == len(more) == 3
    assert "hours worked" in more
    assert table["verdict"].iloc[0] == "★ best"
    naive = next(b for b in app.selectbox if b.label == "Strategy")
    naive.set_value(next(o for o in naive.options if o.startswith("Naive"))).run()
    press(app, "Use this strategy")
    assert app.selectbox(key="sampler").value == "naive"


def test_what_a_second_robot_would_save_on_this_plot_is_said(app):
    go(app, "compare")
    app.multiselect(key="strategy_samplers").set_value(["naive"])
    app.multiselect(key="strategy_robots").set_value([1, 2])
    app.number_input(key="seeds").set_value(3)
    app.number_input(key="n_days").set_value(3).run()
    compare(app)
    assert not app.exception
    assert "A second robot would save " in texts_of(app)
    assert any(name.startswith("2 × Naive") for name in app.table[0].value["strategy"])
    # a team cannot be put to use here: one robot's way can
    box = next(b for b in app.selectbox if b.label == "Strategy")
    assert [option for option in box.options if "×" in option] == []


def test_seasons_are_those_of_the_pest_that_was_chosen(app, monkeypatch):
    begun = []
    monkeypatch.setattr(
        WatchedComparison, "start", lambda self: begun.append(self._laid.pest_in_weather)
    )
    go(app, "plot")
    app.selectbox(key=chosen_pest.WHICH).set_value("whitefly").run()
    go(app, "compare")
    assert not app.exception
    assert "rate" not in {one.key for one in app.number_input}
    assert any("Spreads as the chosen pest" in one.value for one in app.caption)
    app.number_input(key="n_days").set_value(2)
    app.button(key="run").click().run()
    assert [one.pest.name for one in begun] == ["whitefly"]
    go(app, "simulate")
    assert not app.exception
    assert any("Spreads as the chosen pest" in one.value for one in app.caption)
