"""The app's frame: the map on the whole page, a panel beside it; `fieldmon app` runs it."""

from __future__ import annotations

import importlib
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import streamlit as st
from streamlit.runtime.scriptrunner import get_script_run_ctx

_HERE = Path(__file__).resolve().parent
_TOP = next(folder for folder in _HERE.parents if not (folder / "__init__.py").is_file())
# a script belongs to no package by itself: this one to `app`, or to `fieldmon._app` as installed
__package__ = ".".join(_HERE.relative_to(_TOP).parts)
# Streamlit puts the script's own folder on the path in each run, and takes it out again unless it
# is there for good: whatever another thread imports while the path gets shorter may not be found
if str(_HERE) not in sys.path[1:]:
    sys.path.append(str(_HERE))
# the package is found from further up
if str(_TOP) not in sys.path:
    sys.path.insert(0, str(_TOP))
importlib.import_module(__package__)

# little more than this is needed for a first screen: the rest is loaded below
from fieldmon.errors import FieldmonError  # noqa: E402 - after the path is right

from .show import field_map  # noqa: E402
from .startup import first_screen, preload  # noqa: E402
from .state import browser, button_presses, chosen_language, menu, plot_source, widget_memory  # noqa: E402
from .words import language, texts  # noqa: E402
from .words.language import of_error  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from streamlit.delta_generator import DeltaGenerator

#: what shows a page, by the page's title
SHOWN_BY: dict[str, Callable[[], None]] = {}
_IN_PLACE = "page in its place"
# a process that a page starts runs this script, too, where there is nothing to show
IS_SHOWN = get_script_run_ctx(suppress_warning=True) is not None

chosen_language.begin()
st.set_page_config(page_title=texts.TITLE, page_icon="🌱", layout="wide")
st.html(_HERE / "style" / "every_page.css")
st.html(_HERE / "style" / ("dark.css" if browser.is_dark() else "light.css"))
if language.is_right_to_left():
    st.html(_HERE / "style" / "right_to_left.css")
if language.current() != language.ENGLISH:  # a box for files speaks English alone
    st.html(_HERE / "style" / "words_of_files.css")
    size = texts.isolated(f"{st.get_option('server.maxUploadSize')} MB")
    most = texts.UPLOAD_MOST.format(size=size)
    st.html(f'<style>:root{{--upload:"{texts.UPLOAD_BUTTON}";--upload-most:"{most}"}}</style>')
# a slider's knob goes by the browser's own language, its bar always from the left
side = "right" if browser.language() in language.RIGHT_TO_LEFT else "left"
st.html(_HERE / "style" / f"slider_from_{side}.css")
preload.start()


def view(name: str) -> ModuleType:
    """Return a page's module, loaded when it is turned to."""
    return importlib.import_module(f".views.{name}", __package__)


def links() -> None:
    """Show the menu where the window is too narrow for it at the top."""
    with st.container(key="links", horizontal=True):
        for name, page in MENU_PAGES.items():
            st.page_link(page, label=texts.MENU[name], icon=f":material/{menu.MENU[name].icon}:")


def load(*, map_sent: bool = False) -> None:
    """Wait for what a page needs; from then on this run opens the file of a season once."""
    preload.start().load(map_sent=map_sent)
    from fieldmon.monitoring import kept_open  # noqa: PLC0415 - as just loaded

    FILES.enter_context(kept_open())


def shown_page(run: Callable[[], None], **settings: Any) -> st.Page:  # noqa: ANN401 - those of a page
    """Return a page that this script shows, see below."""
    made = st.Page(run, **settings)
    SHOWN_BY[settings["title"]] = run
    return made


def place_of(key: str, name: str) -> DeltaGenerator:
    """Return the place of a page, without what another page left in it."""
    place: Any = st if st.session_state.get(_IN_PLACE) == name else st.empty()
    made: DeltaGenerator = place.container(key=key)
    st.session_state[_IN_PLACE] = name
    return made


def page_of(name: str) -> st.Page:
    """Return the page of an item of the menu: what was chosen in the panel, or how to begin."""

    def run() -> None:
        with place_of("panel", name), st.container(key=f"item_{name}"):
            if name == "plots":
                links()
                load()
                view("plots").show()
            else:
                in_panel(name)

    return shown_page(
        run, title=texts.MENU[name], icon=f":material/{menu.MENU[name].icon}:",
        url_path=name, default=name == "today",
    )  # fmt: skip


def in_panel(name: str) -> None:
    """Show an item of the menu in the panel: where and when, its pages, and who works."""
    notice, head, day, said, body, foot = (
        st.container(key=f"panel_{k}") for k in ("notice", "head", "day", "said", "body", "foot")
    )
    links_, ways, head = head.container(), head.container(), head.container()
    with links_:
        links()
    with said:
        waiting = first_screen.FirstScreen(st.empty())
    load(map_sent=waiting.begin())
    from .actions import ways_in  # noqa: PLC0415
    from .actions.bringing_files import show_left_out  # noqa: PLC0415 - as just loaded
    from .actions.choosing import choose, choose_display, mark_day  # noqa: PLC0415
    from .state import drawn_plot, notices  # noqa: PLC0415

    if name == "today" and ways_in.is_first_run():
        with ways:
            ways_in.show()

    menu.take_from_address(name)
    page = menu.shown_page(name)
    is_planned = page == "today"
    chosen = choose(head, foot, waiting.wait, day if is_planned else None)
    with notice:
        notices.show()
    with said:
        if chosen.choices is not None:
            mark_day(chosen.choices, page)
            show_left_out(chosen.choices)
    with body:
        if chosen.choices is None or (page == "plot" and drawn_plot.is_open()):
            view("plot").bring(chosen.problem)
        else:
            try:
                view("menu").show(name, chosen.choices, view)
            except FieldmonError as error:
                st.error(of_error(error))
    with foot:
        choose_display()


def wide(run: str, *, of_plot: bool) -> None:
    """Show a page of research, which has no place on the map."""
    with place_of("wide", run):
        if not of_plot:
            view(run).show()
            return
        load()
        from .actions.choosing import choose, choose_display  # noqa: PLC0415 - as just loaded

        with st.expander(texts.PLOT_FROM):
            head, foot = st.container(), st.container()
            chosen = choose(head, foot, lambda _: None)
        view(run).show(chosen.choices)
        with foot:
            choose_display()


def page_study() -> None:
    """Show the published simulator."""
    wide("study", of_plot=False)


def page_prior() -> None:
    """Show the study with prior information, on the chosen plot too."""
    wide("prior_study", of_plot=True)


# a click may end the first run of a page before its boxes are there
plot_source.begin_from_address()
field_map.clear()
map_place = st.container(key="map_place")
MENU_PAGES = {name: page_of(name) for name in menu.MENU}
turned = st.navigation(
    {
        "": [*MENU_PAGES.values()],
        texts.RESEARCH: [
            shown_page(page_study, title=texts.STUDY, icon=":material/science:", url_path="study"),
            shown_page(page_prior, title=texts.PRIOR, icon=":material/science:", url_path="prior"),
        ],
    },
    position="top",
)
widget_memory.turn(turned.url_path)
if (item := menu.turned_to()) is not None:
    st.switch_page(MENU_PAGES[item])
with ExitStack() as FILES:
    # as a part of this script: of what stands on a page of its own Streamlit sends nothing with the
    # turn to another, and drops what was sent of it a moment before
    if IS_SHOWN:
        SHOWN_BY[turned.title]()
    with map_place:
        field_map.draw()
    button_presses.forget()
preload.start().shown.set()
