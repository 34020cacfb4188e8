"""What lies under the plot: a file that is brought, or a map that is agreed to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError

from ..state import ground, web_maps, widget_memory
from ..state.brought_files import brought
from ..state.folds import fold
from ..state.kept_ground import Agreement, GroundPicture
from ..words import texts
from ..words.language import in_words, of_error
from . import bringing_files

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.monitoring import Season

    from ..state.choices import Choices
    from ..state.kept_ground import Ground
    from ..words.units import UnitsInLanguage

_WHICH, _ADDRESS = "web_map", "web_map_address"
_OSM, _OTHER = "osm", "other"


def show(choices: Choices) -> None:
    """Show the box for a file, and the maps that can be agreed to."""
    made, agreed = ground.of(choices), ground.agreement(choices.season)
    is_open = made is not None or agreed is not None or ground.GROUND in brought()
    with fold(texts.GROUND, f"ground {choices.plot_key}", is_open=is_open):
        st.caption(texts.GROUND_NOTE)
        _file(choices, made)
        web_map(choices.season, choices.today or choices.on, choices.units)


def _file(choices: Choices, made: Ground | None) -> None:
    bringing_files.show_raster(texts.GROUND_FILE, ground.GROUND)
    file = brought().get(ground.GROUND)
    if file is not None and ground.is_raster(file) and made is not None:
        widget_memory.show(
            st.selectbox, texts.GROUND_SHOWS, list(texts.GROUND_KINDS),
            key=f"{ground.SHOWS} {file.key}", default=ground.shows(file),
            format_func=texts.GROUND_KINDS.__getitem__, filter_mode=None,
        )  # fmt: skip
    if (problem := ground.problem()) is not None and file is not None:
        bringing_files.say(problem, file.asked)
    if made is not None:
        name = texts.isolated(made.name)
        kept = texts.KEPT_FILE if choices.season is None else texts.GROUND_KEPT
        st.caption(kept.format(name=name))
        _say(made)
    if made is not None or file is not None:
        st.button(texts.FORGET_FILE, key="ground_forget", on_click=ground.forget, args=(choices,))


def _say(made: Ground) -> None:
    if ground.said():
        bringing_files.show_messages(ground.said())
    elif isinstance(made, GroundPicture):
        st.markdown("\n".join(f"- {in_words(sentence)}" for sentence in made.said))


def web_map(season: Season | None, today: date, units: UnitsInLanguage) -> None:
    """Ask once, in words that say who then learns what; show what was agreed to, to take back."""
    agreed = ground.agreement(season)
    if agreed is not None:
        host = texts.isolated(web_maps.host(agreed.address))
        day = units.said_day(agreed.on, today)
        st.markdown(texts.WEB_MAP_AGREED.format(host=host, day=day))
        st.button(texts.WEB_MAP_BACK.format(host=host), key="web_map_back", on_click=ground.agree,
                  args=(season, None))  # fmt: skip
        return
    st.selectbox(texts.WEB_MAP, list(texts.WEB_MAPS), key=_WHICH, filter_mode=None,
                 format_func=texts.WEB_MAPS.__getitem__)  # fmt: skip
    which = st.session_state.get(_WHICH, "")
    if which == _OTHER:
        st.text_input(texts.WEB_MAP_ADDRESS, key=_ADDRESS, help=texts.WEB_MAP_HELP,
                      placeholder="https://.../{z}/{x}/{y}.png")  # fmt: skip
    typed = web_maps.OSM if which == _OSM else st.session_state.get(_ADDRESS) or ""
    if not which or not typed:
        return
    try:
        address = web_maps.checked(typed)
    except FieldmonError as error:
        st.error(of_error(error))
        return
    _ask(season, today, address)


def _ask(season: Season | None, today: date, address: str) -> None:
    host = texts.isolated(web_maps.host(address))
    kept = texts.WEB_MAP_SESSION if season is None else texts.WEB_MAP_SEASON
    st.info(f"{texts.WEB_MAP_ASK.format(host=host)} {kept}")
    agreed = Agreement(address, web_maps.credit(address), str(today))
    st.button(texts.WEB_MAP_AGREE.format(host=host), key="web_map_agree", type="primary",
              on_click=ground.agree, args=(season, agreed))  # fmt: skip
