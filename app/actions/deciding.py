"""Deciding: what is assumed, changed there; leaves that were counted; the files that follow."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import shapely
import streamlit as st

from fieldmon.decisions.leaves import of_leaves
from fieldmon.decisions.thresholds import read_thresholds
from fieldmon.errors import FieldmonError, SettingError
from fieldmon.io.options import Upload
from fieldmon.io.writers.treatment_map import said_of_cells, treatment_map_bytes
from fieldmon.reports.advice import advice_report
from fieldmon.reports.html import html_text
from fieldmon.reports.pdf import pdf_bytes

from ..state import deciding, notices, widget_memory
from ..state.chosen_units import units
from ..words import language, texts
from ..words.language import in_words, of_error
from . import treating
from .treating import Zoned

if TYPE_CHECKING:
    from fieldmon.decisions.thresholds import Threshold
    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.monitoring.settings.advice_settings import AdviceSettings
    from fieldmon.reports.content import Report

    from ..state.choices import Choices

# least, most and step of each box
_LIMITS: dict[str, tuple[float, float, float] | tuple[int, int, int]] = {
    "decide level": (0.1, 99.0, 0.5), "decide sure": (51.0, 99.0, 1.0),
    "decide rate": (1.0, 10_000.0, 10.0), "decide rows": (0, 50, 1),
    "decide on": (0.0, 500.0, 1.0), "decide off": (0.0, 500.0, 1.0),
    "decide ring": (0, 10, 1), "decide per_ha": (0.0, 1e6, 10.0),
    "decide per_zone": (0.0, 1e5, 0.5), "decide loss": (0.0, 1e5, 0.1),
    "decide days": (0.0, 365.0, 1.0), "decide works": (1.0, 100.0, 1.0),
    "decide reserve": (0.0, 99.0, 1.0),
}  # fmt: skip
_ASKED = ("decide level", "decide sure")
_SPRAYER = ("decide rows", "decide on", "decide off", "decide ring", "decide rate")
#: what a decision is handed out as: endings of files, the first one offered first
_ENDINGS = (
    ".xml.zip", ".grid1.xml.zip", ".grid2.xml.zip", ".v3.xml.zip", ".v3.grid1.xml.zip",
    ".v3.grid2.xml.zip", ".shp.zip", ".gpkg", ".geojson", ".kml", ".tif",
)  # fmt: skip


def threshold() -> None:
    """Offer the threshold and how sure a verdict must be; they stand beside the answer."""
    with st.container(horizontal=True, vertical_alignment="bottom"):
        for key in _ASKED:
            _box(key)


def assumed(advice: Advice) -> None:
    """Say what the answer assumes, with the way to say otherwise."""
    st.caption(in_words(advice.assumed(units().of_library)))
    with st.expander(texts.ASSUMED_CHANGE):
        st.markdown(f"**{texts.DECIDE_SPRAYER}**")
        for key in _SPRAYER:
            _box(key)
        widget_memory.show(st.text_input, texts.DECIDE_PRODUCT, key=deciding.PRODUCT, default="",
                           max_chars=80)  # fmt: skip
        st.markdown(f"**{texts.DECIDE_COSTS}**")
        for key in deciding.BEGINS:
            if key not in (*_ASKED, *_SPRAYER):
                _box(key, advice.asked.costs.works if key == deciding.WORKS else None)


def _box(key: str, learnt: float | None = None) -> None:
    """Show a box; one whose number may be learnt is empty until somebody says otherwise."""
    low, high, step = _LIMITS[key]
    now = units()
    label = texts.DECIDE_BOXES[key.partition(" ")[2]].format(
        length=texts.UNITS[now.length], area=texts.UNITS[now.area], one_area=in_words(now.one_area)
    )
    begins = type(step)(deciding.shown(key, deciding.BEGINS[key])) if learnt is None else None
    widget_memory.show(
        st.number_input, label, type(step)(deciding.shown(key, low)),
        type(step)(deciding.shown(key, high)), step=step, key=key, default=begins,
        placeholder=None if learnt is None else f"{100 * learnt:.3g}",
    )  # fmt: skip
    said = widget_memory.value(key)
    if key == deciding.WORKS and said is not None and said <= 1:  # as commands take it
        st.warning(texts.TREAT_SHARE.format(said=said, meant=100 * said))


def known_thresholds(choices: Choices) -> None:
    """Offer the published thresholds and those of one's own, each with its source.

    Those of the season's pest come first; of one for another pest it is said.
    A share of the plants is taken for the answer above; of leaves there is a verdict here.
    """
    with st.expander(texts.DECIDE_LEAVES):
        pest = _pest_of(choices)
        known = deciding.thresholds(pest)
        name = widget_memory.show(
            st.selectbox, texts.DECIDE_THRESHOLD, list(known), key="decide leaves of",
            default=next(iter(known)),
            format_func=lambda one: texts.DECIDE_THRESHOLDS.get(one, one),
        )  # fmt: skip
        asked = known[name]
        st.caption(texts.isolated(asked.source))
        if doubt := asked.doubt(pest):
            st.warning(in_words(doubt))
        if asked.measure == "share of plants":
            st.button(texts.DECIDE_TAKE.format(share=asked.level), key="take threshold",
                      on_click=widget_memory.put,
                      args=(deciding.LEVEL, 100 * asked.level))  # fmt: skip
        else:
            _leaves(asked)
        _own()


def _pest_of(choices: Choices) -> str:
    """Return the name of the season's pest; empty: it has none."""
    pest = None if choices.season is None else choices.season.settings.pest
    return "" if pest is None else pest.name


def _own() -> None:
    """Take in thresholds of one's own."""
    brought = st.file_uploader(
        texts.DECIDE_OWN, type=["csv"], key="thresholds_file", help=texts.DECIDE_OWN_HELP
    )
    if brought is not None:
        st.button(texts.DECIDE_OWN_TAKE, key="take_thresholds", on_click=_take,
                  args=(Upload(brought.name, brought.getvalue()),))  # fmt: skip


@notices.reporting
def _take(table: Upload) -> str:
    own = read_thresholds(table)
    deciding.keep_thresholds(own)
    if own:
        widget_memory.put("decide leaves of", own[0].name)
    return texts.DECIDE_OWN_KEPT.format(n=len(own))


def _leaves(asked: Threshold) -> None:
    """Offer a verdict by leaves for a threshold that counts leaves."""
    looked_at = widget_memory.show(st.number_input, texts.DECIDE_LOOKED_AT, 0, 10_000,
                                   key="decide leaves", default=0)  # fmt: skip
    presence = asked.is_share or widget_memory.show(
        st.toggle, texts.DECIDE_PRESENCE, key="decide presence", default=False
    )
    label = texts.DECIDE_LEAVES_INFESTED if presence else texts.DECIDE_COUNTED
    counted = widget_memory.show(st.number_input, label, 0, 1_000_000,
                                 key="decide counted", default=0)  # fmt: skip
    try:
        said = of_leaves(asked, int(looked_at), float(counted), presence=presence)
    except FieldmonError as error:
        st.warning(of_error(error))
    else:
        st.markdown(in_words(said))


def files(choices: Choices, advice: Advice) -> None:
    """Hand out the zones for sprayers, farm programs and phones, and a page to print."""
    product = deciding.product()
    report = partial(_report, choices, advice, product)
    with st.container(horizontal=True):
        st.download_button(
            texts.DECIDE_PDF,
            lambda: pdf_bytes(report(), "a4"),
            f"{choices.file_name('advice')}.pdf",
            "application/pdf",
            on_click="ignore",
        )
        st.download_button(
            texts.REPORT_HTML,
            lambda: html_text(report()),
            f"{choices.file_name('advice')}.html",
            "text/html",
            on_click="ignore",
        )
    if not len(advice.zones):
        return
    ending = st.selectbox(texts.DECIDE_FILE, _ENDINGS, key="decide file",
                          format_func=lambda one: texts.DECIDE_FILES[one[1:]])  # fmt: skip
    name = f"zones_{choices.day}{ending}"
    of = advice.treatment_map(choices.plot.field, product)
    st.download_button(
        texts.DECIDE_DOWNLOAD, lambda: treatment_map_bytes(of, name),
        f"{choices.file_name('zones')}{ending}",
        type="secondary" if advice.is_below else "primary",
        key="decide download", on_click="ignore",
    )  # fmt: skip
    if said := said_of_cells(of, name, choices.units.of_library):
        st.caption(in_words(said))


def treated(choices: Choices, advice: Advice) -> None:
    """Take down that the zones were treated, and with what; what was advised is kept with it."""
    if not len(advice.zones):
        return
    with st.expander(texts.DECIDE_TREATED):
        vines = advice.grid.vines_of(advice.sprayed)
        plants = texts.PLANTS_COUNTED.format(n=int(np.count_nonzero(vines)))
        area = choices.units.square(advice.zones.m2)
        st.caption(texts.DECIDE_TREATED_NOTE.format(plants=plants, area=area))
        treating.show(choices, partial(_zoned, advice, deciding.asked()))


def _zoned(advice: Advice, drawn: AdviceSettings) -> Zoned:
    """Return the zones that were on the page, whatever was found since: those were treated.

    `drawn` are the boxes then: by what is typed since, nobody saw zones.
    """
    if deciding.asked() != drawn:
        raise SettingError(texts.DECIDE_ASKED_SINCE)
    whole = shapely.union_all(advice.outlines)
    return Zoned(shapely.MultiPolygon(list(shapely.get_parts(whole))), advice.in_short())


def _report(choices: Choices, advice: Advice, product: str) -> Report:
    made = advice_report(choices.open_season, choices.on, advice, choices.units.of_library, product)
    return made.said_in(language.for_reports(language.current()))
