"""What a phone saved to a file because it could not send it: findings and photos, as JSON.

A finding is written there as the HTTP interface of a season describes it, with the season it is
of and whose it is. Files of phones from before say neither.
"""

from __future__ import annotations

import base64
import json
import math
import re
from dataclasses import dataclass, replace
from datetime import date, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.compute.ranges import DETECTS, MOST_COUNTED
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, ObservationError
from fieldmon.infestation.inspections import RESULT_CODES
from fieldmon.io.formats.signatures import HEAD_BYTES
from fieldmon.io.import_report import Imported, ImportMessage, dropped
from fieldmon.io.options import Source, Upload, source_name
from fieldmon.io.sandbox.unpack import members

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fieldmon.io.sandbox.workroom import Workroom

#: as `unsent` of `app/scout_page/src/store.js` writes it
KIND = "fieldmon findings"
#: how a phone names a finding or a photo
ID = r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}"
#: letters that a text of a finding may have, and the least and the most that a number may be
LONGEST = {"stage": 60, "notes": 2000, "who": 60, "season": 200}
LEAST_MOST = {
    "plant": (0, 2**31 - 1), "count": (0, MOST_COUNTED), "leaves": (0, 1e9), "lon": (-180, 180),
    "lat": (-90, 90), "accuracy_m": (0, 1e7),
}  # fmt: skip


@dataclass(frozen=True)
class SavedRecord:
    """A finding or a photo that a phone saved.

    Parameters
    ----------
    season, who
        Of what it is, and whose; empty where the file does not say.
    fields
        Of `Finding` or `Photo` in `fieldmon.monitoring`, by their names.
    """

    season: str
    who: str
    fields: dict[str, Any]


@dataclass(frozen=True)
class PhoneFile:
    """What a phone saved.

    Parameters
    ----------
    findings, photos
        In the order in which they were told.
    clocks
        What the phone's clock said then, and the time as far as the phone knew it; None: the file
        does not say.
    """

    findings: tuple[SavedRecord, ...]
    photos: tuple[SavedRecord, ...]
    clocks: tuple[datetime, datetime] | None = None

    def of(self, season: str) -> PhoneFile:
        """Return what is of a season of this name, or of a season that is not named."""
        findings, photos = (
            tuple(one for one in some if one.season in {"", season})
            for some in (self.findings, self.photos)
        )
        return replace(self, findings=findings, photos=photos)

    def by(self, who: str) -> PhoneFile:
        """Return the same as that of somebody, whoever it says."""
        findings, photos = (
            tuple(replace(one, who=who) for one in some) for some in (self.findings, self.photos)
        )
        return replace(self, findings=findings, photos=photos)


def is_phone_file(source: Source) -> bool:
    """Return whether a source begins as what a phone saves."""
    if isinstance(source, tuple):
        return False
    if isinstance(source, Upload):
        head = source.data[:HEAD_BYTES]
    elif Path(source).is_file():
        with Path(source).open("rb") as file:
            head = file.read(HEAD_BYTES)
    else:
        return False
    begins = re.match(rb'\s*\{\s*"(kind|findings)"\s*:\s*("fieldmon findings"|\[)', head)
    return begins is not None


def phone_file_of(source: Source, workroom: Workroom) -> Imported[PhoneFile]:
    """Return what a phone saved; what is not as a phone writes it is left out, and it is said."""
    try:
        (member,) = members(source, workroom)
        told = json.loads(workroom.stage(member).read_bytes())
        lists = [[*told[name]] for name in ("findings", "photos")]
        saved = told.get("saved")
        clocks = None if saved is None else (moment(saved["clock"]), moment(saved["time"]))
    except (ValueError, KeyError, TypeError, RecursionError, ObservationError) as error:
        raise FileProblem(
            worded(
                "{name} must be what a phone saved, but it is not whole. Save it again on the "
                "phone.",
                name=source_name(source),
            )
        ) from error
    messages: list[ImportMessage] = []
    findings = _each(lists[0], fields_of, messages, worded("finding"))
    photos = _each(lists[1], _photo, messages, worded("photo"))
    return Imported(PhoneFile(findings, photos, clocks), tuple(messages))


def fields_of(said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields of a finding from how the interface of a season describes it.

    Raise `ObservationError` where a time, a day or a chance is none.
    """
    lon, lat, result = said.get("lon"), said.get("lat"), said.get("result")
    plant = said.get("plant")
    return {
        "id": said["id"],
        "at": moment(said["at"]),
        "plant": None if plant is None else int(plant),  # JSON's 3.0 is whole, too
        "result": None if result is None else RESULT_CODES[result],
        "count": said.get("count"),
        "stage": said.get("stage", ""),
        "leaves": said.get("leaves"),
        "notes": said.get("notes", ""),
        "lonlat": None if lon is None or lat is None else (lon, lat),
        "accuracy_m": said.get("accuracy_m"),
        "on": day(said.get("on")),
        "after": moment(said["after"]) if said.get("after") else None,
        "known_at": moment(said["known_at"]) if said.get("known_at") else None,
        "off_route": said.get("off_route", False),
        "undoes": said.get("undoes", ""),
        "detects": _chance(said.get("detects")),
    }


def _chance(said: object) -> float | None:
    """Return a chance to see an infested plant; raise `ObservationError` where it is none."""
    if said is None:
        return None
    number = said if isinstance(said, int | float) and not isinstance(said, bool) else math.nan
    if rule := DETECTS.broken(number):
        raise ObservationError(
            worded(
                "The chance to see an infested plant (detects) must be {rule}, but it says {said}.",
                rule=rule, said=str(said)[:60],
            )
        )  # fmt: skip
    return float(number)


def moment(text: str) -> datetime:
    """Return a time that names its zone, or raise `ObservationError`."""
    try:
        read = datetime.fromisoformat(text)
    except ValueError as error:
        raise ObservationError(
            worded("A time must be one that exists, but it is {text!r}.", text=text)
        ) from error
    if read.tzinfo is None:
        raise ObservationError(worded("A time must name its zone, but it is {text!r}.", text=text))
    return read


def day(text: str | None) -> date | None:
    """Return a day, or None where none is said; raise `ObservationError` if it is none."""
    try:
        return date.fromisoformat(text) if text else None
    except ValueError as error:
        raise ObservationError(
            worded("A day must be as 2026-11-18, but it is {text!r}.", text=text)
        ) from error


def _each(
    told: list[Any],
    read: Callable[[Mapping[str, Any]], dict[str, Any]],
    messages: list[ImportMessage],
    kind: str,
) -> tuple[SavedRecord, ...]:
    """Return the records of a list that are as a phone writes them; say which are not."""
    records = []
    for k, one in enumerate(told, 1):
        try:
            _must_be_so(one)
            records.append(SavedRecord(one.get("season") or "", one.get("who") or "", read(one)))
        except (ObservationError, ValueError, KeyError, TypeError, AttributeError) as error:
            what = str(error) if isinstance(error, ObservationError) else ""
            said = worded("It is not as a phone writes it: left out. {what}", what=what)
            messages.append(dropped(said.strip(), f"{kind} {k}"))
    return tuple(records)


def _must_be_so(one: Any) -> None:  # noqa: ANN401 - from a file
    """Raise `ValueError` or what its kind raises unless what is said is of its kind."""
    for name in ("id", *({"undoes", "finding"} & {k for k, v in one.items() if v})):
        if not re.fullmatch(ID, one[name]):
            raise ValueError(name)
    for name, longest in LONGEST.items():
        text = one.get(name)
        if text is not None and (not isinstance(text, str) or len(text) > longest):
            raise ValueError(name)
    for name, (least, most) in LEAST_MOST.items():
        number = one.get(name)
        if number is None:
            continue
        kinds = int if name == "plant" else int | float
        if isinstance(number, bool) or not isinstance(number, kinds) or not math.isfinite(number):
            raise ValueError(name)
        if not least <= number <= most:
            raise ValueError(name)
    if not isinstance(one.get("off_route", False), bool):
        raise TypeError("off_route")


def _photo(said: Mapping[str, Any]) -> dict[str, Any]:
    lon, lat = said.get("lon"), said.get("lat")
    return {
        "id": said["id"],
        "finding": said["finding"],
        "data": base64.b64decode(said["base64"], validate=True),
        "at": moment(said["at"]),
        "lonlat": None if lon is None or lat is None else (lon, lat),
        "accuracy_m": said.get("accuracy_m"),
    }
