"""The app's frame: `fieldmon app` runs it."""

import sys
from pathlib import Path

import streamlit as st

# `streamlit run` puts this file's own folder on the path; the package is one above it
sys.path[:] = [p for p in sys.path if Path(p).resolve() != Path(__file__).resolve().parent]
if str(Path(__file__).resolve().parents[1]) not in sys.path:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from app import cached, texts  # noqa: E402 - after the path is right
from app.choices import choose  # noqa: E402
from app.views import prior_study, season, study, today  # noqa: E402

st.set_page_config(page_title=texts.TITLE, page_icon="🌱", layout="wide")
# Streamlit leaves a hand's breadth above the page, which a phone cannot spare
st.html("<style>[data-testid=stMainBlockContainer]{padding-top:4rem;padding-bottom:3rem}</style>")
cached.warm()


def page_today() -> None:
    """Show today's plan."""
    show(today.show)


def page_season() -> None:
    """Show a simulated season."""
    show(season.show)


def page_prior() -> None:
    """Show the study with prior information, on the chosen plot too."""
    prior_study.show(choose())


def show(page) -> None:  # noqa: ANN001 - a page's function
    """Show a page for what was chosen, or how to begin."""
    choices = choose()
    if choices is None:
        st.title(texts.TITLE)
        st.markdown(texts.EMPTY)
        return
    page(choices)


st.navigation(
    [
        st.Page(
            page_today, title=texts.TODAY, icon=":material/route:", url_path="today", default=True
        ),
        st.Page(page_season, title=texts.SEASON, icon=":material/monitoring:", url_path="season"),
        st.Page(study.show, title=texts.STUDY, icon=":material/science:", url_path="study"),
        st.Page(page_prior, title=texts.PRIOR, icon=":material/science:", url_path="prior"),
    ],
    position="top",
).run()
