"""The robots that are watched, a line each beside the map. No Streamlit in here."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from fieldmon.drive.vda5050.watcher import DOUBLE, ELSEWHERE, FAILED, LOST, WAITING

from ..words import texts
from ..words.language import listed
from .maps import colours

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fieldmon.drive.vda5050.watcher import Heard

    from ..state.live_drive import SeenRobot

#: what of them nobody may overlook
_ALARMS = {DOUBLE, ELSEWHERE, FAILED, LOST, WAITING}
_LINE = (
    '<p style="margin:0 0 .5rem"><span aria-hidden="true" style="display:inline-block;width:.8em;'
    'height:.8em;border-radius:50%;margin-inline-end:.45em;background:rgb{colour}"></span>'
    "<b>{name}</b> · {said}</p>"
)


def as_html(seen: Sequence[SeenRobot], ends: Mapping[str, str], *, dark: bool) -> str:
    """Return a line a robot: how it stands, its battery, what it found, and its planned end.

    `ends` are the planned ends that are known, by name.
    """
    lines = []
    for k, one in enumerate(seen):
        standing = escape(stands(one.heard))
        if one.heard.standing in _ALARMS:
            standing = f"<b>{standing}</b>"
        more = [escape(said) for said in _figures(one, ends.get(one.name, ""))]
        said, name = " · ".join([standing, *more]), escape(texts.isolated(one.name))
        lines.append(_LINE.format(colour=colours.of_robot(k)[dark], name=name, said=said))
    return "".join(lines)


def stands(heard: Heard) -> str:
    """Return how a robot stands, in words."""
    if heard.lag_s is None:
        unheard = "lost_before" if heard.standing == LOST else heard.standing
        return texts.MAP_WORDS[unheard]
    return texts.MAP_WORDS[heard.standing].format(seconds=f"{heard.lag_s:.0f}")


def _figures(one: SeenRobot, end: str) -> list[str]:
    told = [stop.found for stop in one.trace.stops if stop.found is not None]
    said = []
    if (battery := one.heard.battery) is not None:
        said.append(texts.DRIVE_BATTERY.format(share=math.floor(battery)))
    if one.heard.standing not in {WAITING, ELSEWHERE}:
        said.append(texts.DRIVE_INSPECTED.format(n=len(told), found=sum(told)))
    if end:
        said.append(texts.DRIVE_ENDS.format(time=end))
    return said


def cautions(seen: Sequence[SeenRobot]) -> list[str]:
    """Return what must be said of robots besides: who was never heard, by name, and why else."""
    said = []
    if silent := [texts.isolated(one.name) for one in seen if one.heard.standing == WAITING]:
        said.append(texts.DRIVE_NOT_HEARD.format(names=listed(silent)))
    for one in seen:
        name = texts.isolated(one.name)
        if one.heard.standing == DOUBLE:
            said.append(texts.DRIVE_DOUBLE.format(name=name))
        elif one.heard.standing == ELSEWHERE:
            said.append(texts.DRIVE_ELSEWHERE.format(name=name))
        elif one.heard.standing == FAILED:
            said.append(texts.DRIVE_FAILED.format(name=name, said=texts.written(one.heard.said)))
    return said
