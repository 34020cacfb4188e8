"""A study in the app: on the plot that is chosen, with its records, and with a way to stop it."""

import numpy as np
from streamlit.testing.v1 import AppTest

from app.actions.studying import site_of
from app.words import texts
from tests.app.chosen import a_plot, chosen, records_at
from tests.app.driving import PATIENCE_S


def test_a_plot_without_records_leaves_the_start_to_the_study():
    choices = chosen(a_plot())
    site = site_of(choices)
    assert (site.name, site.chance) == ("square", None)
    assert site.aisles is choices.plot.aisles


def test_records_seed_the_start_most_where_they_are():
    plot = a_plot()
    found = [7, 8]
    site = site_of(chosen(plot, records_at(plot, found, [1, 1])))
    assert site.chance.shape == (len(plot.grid),)
    assert set(np.argsort(site.chance)[-2:]) == set(found)


def page(refuses):
    import streamlit as st

    from app.actions import studying
    from fieldmon.errors import SettingError

    def make(progress):
        progress(3, 4)
        if refuses:
            raise SettingError("It must be otherwise.")
        return "made"

    st.session_state["came"] = studying.run("test", make)
    studying.say_stopped("test")


def test_what_a_study_makes_comes_back_and_nothing_is_said_of_stopping():
    app = AppTest.from_function(page, args=(False,), default_timeout=PATIENCE_S).run()
    assert not app.exception
    assert app.session_state["came"] == "made"
    assert [info.value for info in app.info] == []


def test_a_refusal_is_a_sentence_on_the_page():
    app = AppTest.from_function(page, args=(True,), default_timeout=PATIENCE_S).run()
    assert not app.exception
    assert app.session_state["came"] is None
    assert [error.value for error in app.error] == ["It must be otherwise."]


def stopped():
    import streamlit as st

    from app.actions import studying

    st.session_state.setdefault("test at work", True)
    studying.say_stopped("test")


def test_a_study_that_a_click_has_ended_is_said_to_be_stopped_once():
    app = AppTest.from_function(stopped, default_timeout=PATIENCE_S).run()
    assert [info.value for info in app.info] == [texts.STUDY_STOPPED]
