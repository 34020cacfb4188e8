"""What phones send, checked by the interface's own description and read. No Streamlit in here."""

from __future__ import annotations

import json
import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any

from fieldmon.errors import ObservationError
from fieldmon.io.readers.phone_file import LEAST_MOST, day, fields_of, moment
from fieldmon.monitoring.phones.photos import Photo
from fieldmon.monitoring.phones.sent_findings import Finding

from . import description

if TYPE_CHECKING:
    from collections.abc import Mapping
    from datetime import date, datetime


def findings(body: bytes) -> tuple[list[Finding], datetime]:
    """Return what is told, and the phone's clock; raise `ObservationError` if it is not so."""
    sent = _checked(body, "FINDINGS")
    return [Finding(**fields_of(one)) for one in sent["findings"]], moment(sent["sent"])


def plan(text: str | None) -> int | None:
    """Return which plan a phone has; raise `ObservationError` if it is no number."""
    if text is None:
        return None
    if not re.fullmatch("[0-9]{1,15}", text):
        raise ObservationError(f"plan must be the number of a plan, but it is {text[:20]!r}.")
    return int(text)


def asked(body: bytes) -> tuple[date | None, float | None]:
    """Return the day and the seconds left, for whoever asks for the rest of a day."""
    sent = _checked(body or b"{}", "ASKED")
    return day(sent.get("on")), sent.get("seconds_left")


def asked_photo(name: str, body: bytes) -> tuple[int, str]:
    """Return of which plant a photo is asked for, and the note."""
    _matches(name, description.ID)
    sent = _checked(body, "ASKED_PHOTO")
    return int(sent["plant"]), sent.get("note", "")


def photo(name: str, query: Mapping[str, str], data: bytes) -> Photo:
    """Return a photo with what its address says of it."""
    _matches(name, description.ID)
    for known in ("finding", "at"):
        if known not in query:
            raise ObservationError(f"A photo's address must say its {known}, but it does not.")
    _matches(query["finding"], description.ID)
    lon, lat = _number(query, "lon"), _number(query, "lat")
    lonlat = None if lon is None or lat is None else (lon, lat)
    at, accuracy_m = moment(query["at"]), _number(query, "accuracy_m")
    return Photo(name, query["finding"], data, at, lonlat, accuracy_m)


def _number(query: Mapping[str, str], name: str) -> float | None:
    text = query.get(name)
    if not text:
        return None
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    least, most = LEAST_MOST[name]
    if not least <= number <= most:
        raise ObservationError(
            f"{name} must be a number from {least:g} to {most:g}, but it is {text[:60]!r}."
        )
    return number


def _checked(body: bytes, name: str) -> Any:  # noqa: ANN401 - as described
    try:
        sent = json.loads(body, parse_constant=_refused)
    except (ValueError, RecursionError) as error:
        raise ObservationError(f"What is sent must be JSON, but it is not ({error}).") from error
    for wrong in _validator(name).iter_errors(sent):
        where = "/".join(map(str, wrong.absolute_path)) or "it"
        raise ObservationError(
            f"What is sent must be as {description.PATH}/openapi.json says, but {where} is not: "
            f"{wrong.message[:200]}."
        )
    return sent


def _matches(text: str, schema: dict[str, Any]) -> None:
    if not re.fullmatch(schema["pattern"].strip("^$"), text):
        raise ObservationError(f"An id must be a UUID, but it is {text[:60]!r}.")


def _refused(constant: str) -> Any:  # noqa: ANN401
    raise ValueError(f"{constant} is no number")


@cache
def _validator(name: str) -> Any:  # noqa: ANN401 - a tenth of a second to import
    from jsonschema import Draft202012Validator  # noqa: PLC0415

    return Draft202012Validator(getattr(description, name))
