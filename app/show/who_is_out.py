"""Who is out on a day, a line each: rows, code, phone, how far, and what to look after.

No Streamlit in here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.monitoring.days.scouts_out import scouts_out

from ..state import last_heard
from ..words import texts

if TYPE_CHECKING:
    from datetime import datetime, timedelta

    from fieldmon.monitoring.days.scouts_out import ScoutOut

    from ..state.choices import Choices
    from ..state.last_heard import LastHeard


# up to there one counts in minutes
_MOST_MINUTES_H = 2


@dataclass(frozen=True)
class OutLine:
    """What is said of somebody: the name, a title with the rows, the rest, and cautions."""

    name: str
    title: str
    said: str
    cautions: tuple[str, ...]
    has_code: bool


def lines(choices: Choices) -> tuple[OutLine, ...]:
    """Return a line for each who has a code or is of the team."""
    season = choices.open_season
    return tuple(
        _line(choices, one, last_heard.last(season.path, one.name))
        for one in scouts_out(season, choices.on)
    )


def _line(choices: Choices, one: ScoutOut, asked: LastHeard | None) -> OutLine:
    title = texts.isolated(one.name)
    if one.rows is not None:
        signs = choices.plot.grid.line_signs
        low, high = (signs.get(row, row) for row in one.rows)
        title = texts.INVITED.format(name=title, low=low, high=high)
    made = texts.OUT_NO_CODE
    if one.made is not None:
        made = texts.OUT_MADE.format(at=_clock(choices, one.made))
    at = max((at for at in (one.heard, asked and asked.at) if at is not None), default=None)
    parts = [made]
    if at is not None:
        parts.append(texts.OUT_HEARD.format(at=_clock(choices, at)))
    elif one.made is not None:
        parts.append(texts.OUT_SILENT)
    if asked is not None and asked.day == choices.on and asked.since is not None:
        parts.append(texts.OUT_LOADED.format(time=_clock(choices, asked.since)))
    if one.done or one.ahead:
        parts.append(texts.OUT_DONE.format(done=one.done, all=one.done + one.ahead))
    if one.shares:
        others = ", ".join(texts.isolated(name) for name in one.shares)
        parts.append(texts.OUT_SHARES.format(others=others))
    return OutLine(one.name, title, " · ".join(parts), _cautions(choices, one, asked),
                   one.holds)  # fmt: skip


def _cautions(choices: Choices, one: ScoutOut, asked: LastHeard | None) -> tuple[str, ...]:
    is_other = asked is not None and asked.day not in (None, choices.on) and choices.is_today
    said = (
        (not one.has_route, texts.OUT_NO_ROUTE),
        (one.clock_is_wrong, _clock_off(one.fast)),
        (is_other, "" if asked is None or asked.day is None else
         texts.OUT_OTHER_DAY.format(day=choices.units.said_day(asked.day, choices.on))),
        (_is_older(choices, one, asked), texts.OUT_OLDER),
        (bool(one.newer and one.ahead), texts.OUT_NEWER.format(n=one.newer)),
        (bool(one.overlaps), texts.OUT_OVERLAPS.format(
            others=", ".join(texts.isolated(name) for name in one.overlaps))),
    )  # fmt: skip
    return tuple(sentence for holds, sentence in said if holds)


def _is_older(choices: Choices, one: ScoutOut, asked: LastHeard | None) -> bool:
    """Return whether the phone goes by another plan of the day than the one given last."""
    if asked is None or asked.day != choices.on or one.plan is None:
        return False
    return asked.plan != one.plan


def _clock_off(fast: timedelta) -> str:
    """Say how far a phone's clock is off, in what one would count it in."""
    off_h = abs(fast.total_seconds()) / 3600
    if off_h < _MOST_MINUTES_H:
        return texts.OUT_CLOCK.format(minutes=round(off_h * 60))
    return texts.OUT_CLOCK_HOURS.format(hours=round(off_h)) if off_h < 24 else texts.OUT_CLOCK_DAYS


def _clock(choices: Choices, moment: datetime) -> str:
    """Return the time on the plot, with its day where that is not today."""
    local = choices.clock.at(moment)
    if choices.is_today and local.date() == choices.on:
        return f"{local:%H:%M}"
    return f"{choices.units.said_day(local.date(), choices.on)} {local:%H:%M}"
