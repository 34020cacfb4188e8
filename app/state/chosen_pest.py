"""The pest that is looked for and the weather that it meets, as this session was told."""

from __future__ import annotations

from datetime import time
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.compute.digest import digest
from fieldmon.errors import FieldmonError
from fieldmon.infestation.insects.pest_in_weather import PestInWeather
from fieldmon.infestation.prior.pest_prior import prior_for
from fieldmon.io.packaged import pest_names
from fieldmon.io.readers.pest_file import read_pest, shipped_pest
from fieldmon.io.readers.weather_options import WeatherOptions
from fieldmon.plot.local_clock import local_clock

from . import cached_files, widget_memory
from .brought_files import brought, messages_of, settled

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.io.import_report import Imported
    from fieldmon.pests.pest import Pest
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.plot import Plot

    from .brought_files import FileMessage
    from .choices import Choices

#: what its files are kept as
PEST, WEATHER = "pest", "weather"
#: the box that says which pest; no pest, and one from a file
WHICH, NONE, OWN = "which_pest", "", "own"


def options() -> tuple[str, ...]:
    """Return what can be chosen: no pest, those that come along, one from a file."""
    return (NONE, *pest_names(), OWN)


def pest() -> Pest | None:
    """Return the pest that was chosen; None: none was, or its file cannot be used."""
    which = widget_memory.value(WHICH, NONE)
    if which != OWN:
        return shipped_pest(which) if which in pest_names() else None
    file = brought().get(PEST)
    if file is None:
        return None
    _note(PEST, None)
    try:
        return read_pest(file.source)
    except FieldmonError as error:
        _note(PEST, error)
        return None


def weather(plot: Plot, today: date) -> Imported[Weather] | None:
    """Return the weather that was brought; None: none was, or it cannot be used."""
    file = brought().get(WEATHER)
    if file is None:
        return None
    _note(WEATHER, None)
    ends = local_clock(plot.field).moment(today, time(23, 59))
    try:
        wanted = settled(file, WeatherOptions(now=ends)).on(plot.field)
        return cached_files.weather(file.key, wanted, file.source)
    except FieldmonError as error:
        _note(WEATHER, error)
        return None


def messages(plot: Plot, today: date) -> tuple[FileMessage, ...]:
    """Return what the weather's import had to say."""
    read = weather(plot, today)
    return () if read is None else messages_of(brought()[WEATHER], read)


def met(choices: Choices) -> Weather | None:
    """Return the weather for what is chosen."""
    read = weather(choices.plot, choices.today or choices.on)
    return None if read is None else read.value


def in_weather(choices: Choices) -> PestInWeather | None:
    """Return the pest in its weather from the day on, the season's own; None: nobody named one."""
    if (season := choices.season) is not None:
        known = season.settings.pest, season.settings.weather
    else:
        known = pest(), met(choices)
    return None if known[0] is None else PestInWeather(known[0], known[1], choices.on)


def key(known: PestInWeather | None) -> str:
    """Return what stands for a pest in its weather in cache keys."""
    return "" if known is None else digest(*known.content, length=16)


def prior(settings: PriorSettings, plot: Plot, today: date, on: date) -> PriorSettings:
    """Return how records become chances, as the pest and its weather have it."""
    chosen = pest()
    if chosen is None:
        return settings
    read = weather(plot, today)
    return prior_for(settings, chosen, None if read is None else read.value, on)


def problem(kind: str) -> FieldmonError | None:
    """Return why a file could not be used when it was last read."""
    found: FieldmonError | None = st.session_state.get(f"{kind} problem")
    return found


def _note(kind: str, error: FieldmonError | None) -> None:
    st.session_state[f"{kind} problem"] = error
