"""What phones and robots send of plants, and when each thing was seen by a clock that is right."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from datetime import date, datetime, timedelta
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError
from fieldmon.monitoring.settings.settings import seconds

if TYPE_CHECKING:
    from fieldmon.plot.local_clock import LocalClock

#: a clock as wrong as this was set wrong; less is the way through the network
CLOCK_IS_WRONG = timedelta(minutes=2)


@dataclass(frozen=True)
class Finding:
    """What somebody tells of one plant, or that an earlier finding is taken back.

    Parameters
    ----------
    id
        Made where it was told, unlike any other: a UUID.
    at
        When, by the clock of the phone; it names its zone.
    plant, result
        Number in the grid, and `CLEAN`, `FOUND` or `SKIPPED`; None where it only takes back.
    count, stage, leaves
        Of a find: pests counted, their stage, leaves looked at.
    notes
        Text.
    lonlat, accuracy_m
        Where the phone was, and how well it knew.
    on
        The day it is meant for, where that is not today; another one than `at` has no time.
    after
        The least that the time can be, by the season's clock; None: nothing is known.
    known_at
        When, by the season's clock as far as the phone knew it then; None: it did not.
    off_route
        Whether the plant was not on the route.
    undoes
        Id of the finding that it takes back.
    detects
        Chance to see an infested plant that is inspected; None: it is that of the season.
    """

    id: str
    at: datetime
    plant: int | None = None
    result: int | None = None
    count: float | None = None
    stage: str = ""
    leaves: float | None = None
    notes: str = ""
    lonlat: tuple[float, float] | None = None
    accuracy_m: float | None = None
    on: date | None = None
    off_route: bool = False
    undoes: str = ""
    after: datetime | None = None
    detects: float | None = None
    known_at: datetime | None = None

    def content(self) -> str:
        """Return what it says as JSON, the same for the same finding whichever version told it."""
        return json.dumps(
            what_is_said(asdict(self)), default=str, sort_keys=True, ensure_ascii=False
        )


#: what a finding has where nothing is said
_UNSAID = {one.name: one.default for one in fields(Finding)}


def what_is_said(content: dict[str, object]) -> dict[str, object]:
    """Return what of a finding's content is said; older files hold what is not, too."""
    return {name: value for name, value in content.items() if value != _UNSAID.get(name)}


@dataclass(frozen=True)
class SentFindings:
    """What came at once.

    Parameters
    ----------
    findings
        What is told.
    clocks
        Ours and the phone's as it came.
    arrived
        When it left the phone: none of it was told after that.
    shift
        By how much the phone's clock was ahead then.
    """

    findings: list[Finding]
    clocks: tuple[datetime, datetime]
    arrived: datetime
    shift: timedelta


def when_seen(clock: LocalClock, one: Finding, letter: SentFindings) -> tuple[date, float]:
    """Return a finding's day, and its second or NaN; raise `ObservationError` if no day is sure.

    No time is believed after its arrival, or before the least that it can be.
    """
    received, named = letter.arrived, one.on
    least = one.after if one.after is None or one.after <= received + CLOCK_IS_WRONG else None
    earliest = None if least is None else least - CLOCK_IS_WRONG
    at = _moment(one, letter, earliest)
    local, is_believed = clock.at(at), _can_be(at, letter, earliest)
    if named is not None:
        return named, seconds(local.time()) if is_believed and named == local.date() else np.nan
    if is_believed:
        return local.date(), seconds(local.time())
    day = clock.at(received).date()
    if least is None or clock.at(least).date() != day:
        raise ObservationError(
            worded(
                "The clock of the phone was wrong when this was recorded ({at}), so nobody knows "
                "its day. Record it by hand.",
                at=f"{local:%Y-%m-%d %H:%M}",
            )
        )
    return day, np.nan


def _moment(one: Finding, letter: SentFindings, earliest: datetime | None) -> datetime:
    """Return when a finding was made: by what its clock was off then, else as it sends.

    A phone that sleeps does not notice that its clock is set ahead. Where that may have been since
    it last heard the season's clock, what it is off as it sends tells more.
    """
    put_right = one.at - letter.shift
    if one.known_at is None or not _can_be(one.known_at, letter, earliest):
        return put_right
    set_ahead = one.known_at - put_right
    asleep = timedelta() if one.after is None else one.known_at - one.after
    return put_right if CLOCK_IS_WRONG < set_ahead <= asleep else one.known_at


def _can_be(at: datetime, letter: SentFindings, earliest: datetime | None) -> bool:
    return at <= letter.arrived + CLOCK_IS_WRONG and (earliest is None or at >= earliest)
