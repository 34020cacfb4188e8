"""Inspections as field observations of IPM Decisions, as its decision support models take them.

Two lists of one length: where, when, which pest and crop; and what was counted there. Source:
IPM Decisions, DSS API user guide and its schema "Field observation", version 0.1 (NIBIO 2020,
github.com/H2020-IPM-Decisions/DSSService); pests and crops are EPPO codes, gd.eppo.int.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from datetime import UTC, datetime, time, timedelta
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.infestation.inspections import FOUND

if TYPE_CHECKING:
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.local_clock import LocalClock

#: what stands for the time of an inspection that has none
_NOON = time(12)


@dataclass(frozen=True)
class EppoCodes:
    """Which pest was looked for on which crop.

    Parameters
    ----------
    pest, crop
        EPPO codes: six letters or figures of a pest as ``TETRUR``, five of a plant as ``LYPES``.

    Raises
    ------
    SettingError
        If one of them is none.
    """

    pest: str
    crop: str

    def __post_init__(self) -> None:
        for what, code, example, most in (
            ("pest", self.pest, "TETRUR for the two-spotted spider mite", 6),
            ("crop", self.crop, "LYPES for tomato", 5),
        ):
            if not re.fullmatch(rf"[A-Z0-9]{{5,{most}}}", code):
                raise SettingError(
                    worded(
                        "The {what} must be an EPPO code, such as {example} (see gd.eppo.int), but "
                        "it is {code!r}.",
                        what=what,
                        example=example,
                        code=code,
                    )
                )


def field_observations(
    inspections: Inspections, grid: PlantGrid, clock: LocalClock, codes: EppoCodes
) -> dict[str, list[dict[str, Any]]]:
    """Return inspections as field observations, in their order; those skipped are none.

    An inspection whose time nobody said stands at noon.
    """
    seen = inspections.inspected
    places = np.round(grid.lonlat(seen.plant), 7).tolist()
    columns = zip(
        places,
        seen.date.tolist(),
        seen.second.tolist(),
        seen.result.tolist(),
        seen.count.tolist(),
        strict=True,
    )
    observed, counted = [], []
    for place, on, second, result, count in columns:
        local = datetime.combine(on, _NOON)
        if not np.isnan(second):
            local = datetime.combine(on, time()) + timedelta(seconds=second)
        observed.append(
            {
                "location": {"type": "Point", "coordinates": place},
                "time": _written(clock, local),
                "pestEPPOCode": codes.pest,
                "cropEPPOCode": codes.crop,
            }
        )
        known = {} if np.isnan(count) else {"pestCount": count}
        counted.append({"infested": bool(result == FOUND), **known})
    return {"fieldObservations": observed, "fieldObservationQuantifications": counted}


def observations_json(*parts: dict[str, list[dict[str, Any]]]) -> bytes:
    """Return field observations of one season or several as one file."""
    whole: dict[str, list[dict[str, Any]]] = {}
    for part in parts:
        for name, values in part.items():
            whole.setdefault(name, []).extend(values)
    return json.dumps(whole, ensure_ascii=False, indent=1).encode()


def _written(clock: LocalClock, local: datetime) -> str:
    """Return a local time as ``yyyy-MM-dd'T'HH:mm:ssXXX``."""
    moment = clock.moment(local.date(), local.time())
    ahead = moment.utcoffset() or timedelta()
    if ahead % timedelta(minutes=1):  # offsets of whole minutes only
        return f"{moment.astimezone(UTC):%Y-%m-%dT%H:%M:%S}Z"
    return moment.isoformat(timespec="seconds")
