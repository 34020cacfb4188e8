"""Boxes that open by themselves."""

from streamlit.testing.v1 import AppTest


def page():
    import streamlit as st

    from app.state.folds import fold

    for name in ("one", "other"):
        with fold(name, name, is_open=st.session_state.get("open") == name):
            st.text("inside")


def is_open(run):
    return [one.proto.expanded for one in run.expander]


def test_a_box_opens_by_itself_and_stays_open_for_the_hand_that_is_in_it():
    run = AppTest.from_function(page).run()
    assert is_open(run) == [False, False]
    run.session_state["open"] = "one"
    assert is_open(run.run()) == [True, False]
    run.session_state["open"] = ""
    assert is_open(run.run()) == [True, False]
