"""What can be compared."""

from tests.app.driving import go


def test_comparing_nothing_is_said_in_a_sentence(app):
    go(app, "compare")
    app.multiselect(key="strategy_samplers").set_value([]).run()
    assert not app.exception
    assert "Choose fewer" in app.warning[0].value
