"""The page of the study with prior information, driven without a browser."""

import pytest
from streamlit.testing.v1 import AppTest

from tests.app.driving import PATIENCE_S


def page():
    """Stand for the app's frame: AppTest cannot turn pages made of functions."""
    import streamlit as st

    from app.actions.choosing import choose
    from app.views import prior_study

    prior_study.show(choose(st.container(), st.container(), lambda _: None).choices)


@pytest.fixture
def app():
    return AppTest.from_function(page, default_timeout=PATIENCE_S).run()


def test_a_scenario_is_shown_beside_its_figures(app):
    assert not app.exception
    assert len(app.dataframe) == 0
    app.number_input(key="prior_seeds").set_value(2)
    app.button(key="prior_run").click().run()
    assert not app.exception
    compared, table = (frame.value for frame in app.dataframe)
    assert {"67", "53", "47"} <= {str(value) for value in compared["published"]}
    assert set(table["sampler"]) == {"dynamic", "naive", "bouncy"}


def test_the_own_plot_is_played_from_its_records(app):
    app.number_input(key="prior_seeds").set_value(2)
    app.selectbox(key="prior_part").set_value("This plot").run()
    app.button(key="prior_run").click().run()
    assert not app.exception
    (table,) = (frame.value for frame in app.dataframe)
    assert set(table["plot"]) == {"Gate"}
    assert table["plants"].min() > 3000


def test_another_choice_leaves_the_old_result(app):
    app.number_input(key="prior_seeds").set_value(2)
    app.button(key="prior_run").click().run()
    app.number_input(key="prior_seeds").set_value(3).run()
    assert len(app.dataframe) == 0
