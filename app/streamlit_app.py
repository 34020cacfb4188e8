"""The app's frame: `fieldmon app` runs it."""

import importlib
import sys
from pathlib import Path

import streamlit as st

# `streamlit run` puts this file's own folder on the path; the package is one above it
sys.path[:] = [p for p in sys.path if Path(p).resolve() != Path(__file__).resolve().parent]
if str(Path(__file__).resolve().parents[1]) not in sys.path:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

# little more than this is needed for a first look at the map: the rest is loaded below
from app import early, remembered, texts, warming  # noqa: E402 - after the path is right
from fieldmon.errors import FieldmonError  # noqa: E402

st.set_page_config(page_title=texts.TITLE, page_icon="🌱", layout="wide")
# Streamlit leaves a hand's breadth above the page, which a phone cannot spare; names in Hebrew or
# Arabic are set from the right, each by its own first letter
# what moves is drawn sixty times a second: without a graphics card that takes seconds from a map
# that is being made, so placeholders stand still and the sign of working turns in steps
st.html(
    "<style>[data-testid=stMainBlockContainer]{padding-top:4rem;padding-bottom:3rem}"
    "[data-testid=stSkeleton],[data-testid=stSkeleton] *{animation:none!important}"
    "[data-testid=stSpinnerIcon]{animation-timing-function:steps(6)!important}"
    "h1,h2,h3,[data-testid=stMarkdownContainer] p{unicode-bidi:plaintext}"
    ".st-key-start_scouting a{border:1px solid rgba(128,128,128,.5);border-radius:.5rem;"
    "min-height:2.5rem;padding:.25rem .75rem;margin:0}"
    ".st-key-start_scouting [data-testid=stElementContainer]{margin:0}"
    # on a phone the table's own tools always show, over the box above it
    ".st-key-route_marks [data-testid=stElementToolbar]{display:none}</style>"
)
if early.is_dark():
    # Streamlit writes white on the pale green of the dark theme: 2:1, where AA asks for 4.5:1
    st.html(
        "<style>[data-testid^=stBaseButton-primary]:enabled,"
        "[data-testid^=stBaseButton-primary]:enabled *,[data-tag],[data-tag] *"
        "{color:#0b1f14!important}</style>"
    )
else:
    # captions and charts' words are 4.3:1 and 3.7:1 on white by themselves
    st.html(
        "<style>[data-testid=stCaptionContainer],[data-testid=stVegaLiteChart] text"
        "{color:#59625c!important;fill:#59625c!important;opacity:1}</style>"
    )
warming.start()


def view(name: str):  # noqa: ANN201 - a page's module
    """Return a page's module, loaded when it is turned to."""
    return importlib.import_module(f"app.views.{name}")


def page(name: str, title: str, icon: str, path: str = "") -> st.Page:
    """Return a page that shows what was chosen, or how to begin."""
    path = path or name

    def run() -> None:
        # a box of its own, empty or not: a map below that moves by a place forgets its zoom
        said = st.container()
        places = (early.places(),) if name == "today" else ()
        warming.start().load(map_sent=bool(places))
        from app import keeping  # noqa: PLC0415 - as just loaded
        from app.choices import choose  # noqa: PLC0415

        chosen = choose(*places)
        with said:
            keeping.said()
        if chosen.choices is None:
            view("plot").bring(chosen.problem)
            return
        try:
            view(name).show(chosen.choices, *places)
        except FieldmonError as error:
            st.error(str(error))

    return st.Page(
        run, title=title, icon=f":material/{icon}:", url_path=path, default=path == "today"
    )


def page_prior() -> None:
    """Show the study with prior information, on the chosen plot too."""
    from app.choices import choose  # noqa: PLC0415 - as above

    view("prior_study").show(choose().choices)


def page_study() -> None:
    """Show the published simulator."""
    view("study").show()


scouting = page("scout", texts.SCOUTING, "eco")
st.session_state["scout_page"] = scouting
# a click may end the first run of a page before its sidebar is there
remembered.first("season", st.query_params.get("season"))
turned = st.navigation(
    [
        page("today", texts.TODAY, "route"),
        page("field", texts.MAP, "map", "map"),
        scouting,
        page("season", texts.SEASON, "calendar_month"),
        page("compare", texts.COMPARE, "balance"),
        page("plot", texts.PLOT, "polyline"),
        page("report", texts.REPORT, "print"),
        page("simulate", texts.SIMULATE, "bug_report"),
        st.Page(page_study, title=texts.STUDY, icon=":material/science:", url_path="study"),
        st.Page(page_prior, title=texts.PRIOR, icon=":material/science:", url_path="prior"),
    ],
    position="top",
)
remembered.turn(turned.url_path)
turned.run()
warming.start().shown.set()
