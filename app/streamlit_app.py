"""The app's frame: `fieldmon app` runs it."""

import importlib
import sys
from pathlib import Path

import streamlit as st

_HERE = Path(__file__).resolve().parent
_TOP = next(folder for folder in _HERE.parents if not (folder / "__init__.py").is_file())
# a script belongs to no package by itself: this one to `app`, or to `fieldmon._app` as installed
__package__ = ".".join(_HERE.relative_to(_TOP).parts)
# Streamlit puts the script's own folder on the path; the package is found from further up
sys.path[:] = [p for p in sys.path if Path(p).resolve() != _HERE]
if str(_TOP) not in sys.path:
    sys.path.insert(0, str(_TOP))
importlib.import_module(__package__)

# little more than this is needed for a first screen: the rest is loaded below
from fieldmon.errors import FieldmonError  # noqa: E402 - after the path is right

from .startup import first_screen, preload  # noqa: E402
from .state import browser, plot_source, widget_memory  # noqa: E402
from .words import texts  # noqa: E402

st.set_page_config(page_title=texts.TITLE, page_icon="🌱", layout="wide")
st.html(_HERE / "style" / "every_page.css")
st.html(_HERE / "style" / ("dark.css" if browser.is_dark() else "light.css"))
preload.start()


def view(name: str):  # noqa: ANN201 - a page's module
    """Return a page's module, loaded when it is turned to."""
    return importlib.import_module(f".views.{name}", __package__)


def page(name: str, title: str, icon: str, path: str = "") -> st.Page:
    """Return a page that shows what was chosen, or how to begin."""
    path = path or name

    def run() -> None:
        # a box of its own, empty or not: a map below that moves by a place forgets its zoom
        above = st.container()
        places = (first_screen.places(),) if name == "today" else ()
        preload.start().load(map_sent=bool(places))
        from .actions.bringing_files import show_left_out  # noqa: PLC0415
        from .actions.choosing import choose, mark_day  # noqa: PLC0415 - as just loaded
        from .state import notices  # noqa: PLC0415

        chosen = choose(first_screen.waiting(*places))
        with above:
            notices.show()
            if chosen.choices is not None:
                mark_day(chosen.choices)
                show_left_out(chosen.choices)
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
    from .actions.choosing import choose  # noqa: PLC0415 - as above

    view("prior_study").show(choose(first_screen.waiting()).choices)


def page_study() -> None:
    """Show the published simulator."""
    view("study").show()


scouting = page("scout", texts.SCOUTING, "eco")
st.session_state["scout_page"] = scouting
# a click may end the first run of a page before its sidebar is there
plot_source.begin_from_address()
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
widget_memory.turn(turned.url_path)
turned.run()
preload.start().shown.set()
