"""Noting a treatment: where, with what, how, by whom and why; and when harvest begins."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import streamlit as st

from fieldmon.decisions.doses import Dose
from fieldmon.decisions.label_file import read_labels
from fieldmon.decisions.labels import WAITS_DAYS, irac_groups
from fieldmon.errors import SettingError
from fieldmon.io.options import Upload
from fieldmon.io.read import read_treated
from fieldmon.monitoring import Application
from fieldmon.monitoring.days.advised import advise
from fieldmon.plot.named_rows import plants_in_rows

from ..show import cautions
from ..state import notices, wishes
from ..state.fresh_boxes import FreshBoxes
from ..words import texts
from ..words.language import in_words, listed
from . import acting

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.io.import_report import Imported

    from ..state.choices import Choices
    from ..words.units import UnitsInLanguage

# boxes of the form for where it was
_ROWS, _SELECTED, _FILE = "treat rows", "treat selected", "treat file"
#: boxes of the form for what was said of an application, by what they are about
_TEXTS = (
    *("active_ingredient", "operator", "reason", "machinery", "weather", "crop", "pest"),
    "authorised_by",
)


@dataclass(frozen=True, eq=False)
class Zoned:
    """Where zones were treated, lon/lat, and what was advised, for the season's log."""

    area: MultiPolygon
    advised: str


def show(choices: Choices, zones: Callable[[], Zoned] | None = None) -> None:
    """Show the form for a treatment of the open season, and note it on demand.

    Parameters
    ----------
    choices
        With a season.
    zones
        Returns where it was, as the zones of a decision that are on the page; None: on the whole
        plot, unless a part is named or selected.
    """
    # what was typed on one page is of its own place
    boxes = FreshBoxes("treatment" if zones is None else "treatment of zones", choices)
    if zones is None:
        _where(boxes)
    st.file_uploader(texts.TREAT_FILE, key=boxes.key(_FILE), help=texts.TREAT_FILE_HELP)
    boxes.show(st.number_input, texts.TREAT_EFFICACY, 0.0, 100.0, step=5.0, box="efficacy")
    boxes.show(st.text_input, texts.TREAT_PRODUCT, box="product", default="")
    with st.expander(texts.TREAT_RECORD):
        _boxes(boxes)
    acting.at_press(texts.TREAT_BUTTON, _treat, choices, boxes, zones, key="treat", boxes=boxes)
    _harvest(choices)
    with st.expander(texts.LABELS):
        _labels(choices)


def _where(boxes: FreshBoxes) -> None:
    """Ask for the part of the plot that was treated: rows, or what is selected on the map."""
    if some := wishes.picked(boxes.choices.laid):
        plants = texts.PLANTS_COUNTED.format(n=len(some))
        st.checkbox(texts.TREAT_SELECTED.format(plants=plants), value=True,
                    key=boxes.key(_SELECTED))  # fmt: skip
    if boxes.choices.plot.grid.in_rows:
        boxes.show(st.text_input, texts.TREAT_ROWS, box=_ROWS, default="", placeholder="3-5,8",
                   help=texts.TREAT_ROWS_HELP)  # fmt: skip


def _plants(boxes: FreshBoxes) -> NDArray[np.bool_] | None:
    """Return the plants ``(n,)`` of the part that was treated; None: it was the whole plot."""
    grid, rows = boxes.choices.plot.grid, (boxes.said(_ROWS) or "").strip()
    ways = boxes.said(_FILE) is not None, bool(boxes.said(_SELECTED)), bool(rows)
    if sum(ways) > 1:
        raise SettingError(texts.TREAT_TWICE)
    if boxes.said(_SELECTED):
        return np.isin(np.arange(len(grid)), wishes.picked(boxes.choices.laid))
    return plants_in_rows(grid, rows) if rows else None


def _of_file(boxes: FreshBoxes) -> Imported[MultiPolygon] | None:
    """Return the area that a file says was treated; None: there is no file."""
    brought = boxes.said(_FILE)
    return None if brought is None else read_treated(Upload(brought.name, brought.getvalue()))


def _boxes(boxes: FreshBoxes) -> None:
    """Show what a certifier asks of each treatment."""
    units, show = boxes.choices.units, boxes.show
    area = texts.UNITS[units.area]
    # each row has columns of its own: on a phone a dose stays with its unit
    left, right = st.columns(2)
    show(left.number_input, texts.TREAT_DOSE, 0.0, None, box="treat dose")
    show(right.text_input, texts.TREAT_UNIT, box="treat unit", default="", placeholder="l/ha")
    water = texts.TREAT_WATER.format(area=area)
    left, right = st.columns(2)
    show(left.number_input, water, 0.0, None, box=_water(units))
    show(right.text_input, texts.TREAT_GROUP, box="treat group", default="",
         help=texts.TREAT_GROUP_HELP)  # fmt: skip
    by_label = texts.TREAT_BY_LABEL
    left, right = st.columns(2)
    show(left.number_input, texts.TREAT_WAIT, 0, None, box="treat days", help=by_label)
    show(right.number_input, texts.TREAT_ENTRY, 0.0, None, box="treat hours", help=by_label)
    left, right = st.columns(2)
    show(left.time_input, texts.TREAT_BEGAN, box="treat began")
    show(right.time_input, texts.TREAT_ENDED, box="treat ended", help=texts.TREAT_ENDED_HELP)
    for name in _TEXTS:
        show(st.text_input, texts.TREAT_TEXTS[name], box=f"treat {name}", default="")


def _water(units: UnitsInLanguage) -> str:
    """Return the box of the water, one for each unit: a number keeps the unit it was typed in."""
    return f"treat water {units.area}"


def _said(boxes: FreshBoxes) -> Application:
    """Return what the boxes say."""
    units, said = boxes.choices.units, boxes.said
    water = said(_water(units))
    dose, unit = said("treat dose"), said("treat unit").strip()
    if bool(dose) != bool(unit):
        raise SettingError(texts.TREAT_DOSE_UNSAID)
    days = said("treat days")
    return Application(
        product=said("product").strip(),
        dose=Dose(float(dose), unit) if dose else None,
        water_l_ha=units.by_hectare(water) if water else None,
        waiting_days=None if days is None else int(days),
        reentry_hours=said("treat hours"),
        irac_groups=irac_groups(said("treat group")),
        began=said("treat began"),
        ended=said("treat ended"),
        **{name: said(f"treat {name}").strip() for name in _TEXTS},
    )


@notices.reporting
def _treat(choices: Choices, boxes: FreshBoxes, zones: Callable[[], Zoned] | None) -> str:
    """Note a treatment; say what to beware of because of it."""
    efficacy, season = boxes.said("efficacy"), choices.open_season
    said = _said(boxes)
    if efficacy is None and not said.product:
        raise SettingError(texts.TREAT_UNSAID)
    if efficacy is not None and 0 < efficacy <= 1:  # as the command takes it
        raise SettingError(texts.TREAT_SHARE.format(said=efficacy, meant=100 * efficacy))
    works = None if efficacy is None else efficacy / 100
    plants, read = (_plants(boxes) if zones is None else None), _of_file(boxes)
    zoned = None if zones is None or read is not None else zones()
    if zoned is not None:
        advise(season, choices.on, zoned.advised)
    area = None if zoned is None else zoned.area
    if read is not None:
        area = read.value
    done = season.treat(choices.on, works, area, application=said, plants=plants)
    boxes.empty()
    if plants is not None:
        wishes.pick(choices.laid, ())
    if done.batch is None:
        return texts.TREATED_BEFORE
    beware = [
        in_words(one.sentence)
        for one in season.cautions(
            choices.on, choices.units.in_sentences(choices.on), because_of=done.batch
        )
    ]
    beware += [in_words(one.sentence) for one in (read.messages if read is not None else ())]
    beware += [ahead] if (ahead := cautions.not_come(choices, choices.on)) else []
    if beware:
        notices.warn()
    noted = texts.TREATED
    if plants is not None or area is not None:
        (kept,) = (one for one in season.treatments() if one.batch == done.batch)
        n = int(np.count_nonzero(season.plot.grid.vines_of(kept.place.plants)))
        noted = texts.TREATED_PART.format(plants=texts.PLANTS_COUNTED.format(n=n))
    return "\n- ".join([noted, *beware])


# -- the harvest


def ask_wait(choices: Choices) -> None:
    """Ask how long a treatment has to be waited for, where no day of harvest is named for it."""
    first = choices.open_season.harvest_from(choices.on)
    if first is None or first[0] is not None or not (product := first[1].application.product):
        return
    boxes = FreshBoxes("wait", choices)
    with st.container(horizontal=True, vertical_alignment="bottom", key="wait_of"):
        label = texts.WAIT_OF.format(product=texts.isolated(product))
        boxes.show(st.number_input, label, 0, int(WAITS_DAYS.most), box="wait days",
                   help=texts.WAIT_HELP)  # fmt: skip
        acting.at_press(texts.WAIT_BUTTON, _say_wait, choices, product, boxes, key="say_wait",
                        boxes=boxes)  # fmt: skip


@notices.reporting
def _say_wait(choices: Choices, product: str, boxes: FreshBoxes) -> str:
    days = boxes.said("wait days")
    if days is None:
        raise SettingError(texts.WAIT_UNSAID)
    choices.open_season.say_wait(product, int(days))
    boxes.empty()
    return texts.WAIT_KEPT.format(product=texts.isolated(product))


def _harvest(choices: Choices) -> None:
    """Show when harvest begins, and change it on demand."""
    ask_wait(choices)
    settings = choices.open_season.settings
    harvest = settings.harvest
    st.date_input(
        texts.HARVEST, harvest, min_value=settings.begins, key=f"harvest {harvest}",
        format=choices.units.date_format, help=texts.HARVEST_HELP,
        on_change=_change_harvest, args=(choices, f"harvest {harvest}"),
    )  # fmt: skip


@notices.reporting
def _change_harvest(choices: Choices, key: str) -> str:
    settings = choices.open_season.settings
    choices.open_season.change(replace(settings, harvest=st.session_state[key]), settings)
    return texts.HARVEST_KEPT


# -- the label table


def _labels(choices: Choices) -> None:
    """Show the products of the season's label table, and take in another table."""
    st.caption(texts.LABELS_NOTE)
    known = choices.open_season.labels()
    if known:
        st.markdown(listed(dict.fromkeys(texts.isolated(one.product) for one in known)))
    boxes = FreshBoxes("labels", choices)
    brought = st.file_uploader(texts.LABELS_IN, type=["csv"], key=boxes.key("labels_file"))
    if brought is not None:
        acting.at_press(texts.LABELS_BUTTON, _take_labels, choices, boxes, key="take_labels",
                        boxes=boxes)  # fmt: skip


@notices.reporting
def _take_labels(choices: Choices, boxes: FreshBoxes) -> str:
    brought = boxes.said("labels_file")
    if brought is None:  # taken out again
        return ""
    table = Upload(brought.name, brought.getvalue())
    read = read_labels(table)
    n = choices.open_season.keep_labels(read.value, table.name)
    boxes.empty()
    said = "".join(f"\n- {in_words(message.sentence)}" for message in read.messages)
    return texts.LABELS_KEPT.format(n=n) + said
