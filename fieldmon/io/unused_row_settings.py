"""What was said of a plot's rows by hand and is not used, since something else says it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, joined, worded
from fieldmon.io.import_report import dropped

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.plot_request import PlantingChoices
    from fieldmon.plot.field import Field

_CALLED = {
    "row_bearing_deg": worded("row bearing"),
    "row_spacing_m": worded("row spacing"),
    "plant_spacing_m": worded("plant spacing"),
    "headland_m": worded("headland"),
    "faces": worded("faces"),
    "half_canopy_m": worded("reach of plants"),
}
_SEVERAL = 2


def unused_of(field: Field, choices: PlantingChoices) -> tuple[ImportMessage, ...]:
    """Return what to say of settings of rows that do not count on a plot.

    Rows of measured plants say themselves how far apart they are (`Plot.doubts`).
    """
    given = choices.given()
    if not choices.in_rows:
        if not given:
            return ()
        said = worded("Plants in no rows have none of what was said of them: {names}.",
                      names=_names(given))  # fmt: skip
        return (dropped(said),)
    if field.plants is not None:
        return ()
    if field.blocks:
        return _in_blocks(field, given)
    if drawn := _by_rows(len(field.row_lines.geoms), given):
        said = worded("Rows run as they were drawn, and not as was said: {names}.",
                      names=_names(drawn))  # fmt: skip
        many = "On {n} plots rows run as they were drawn, and not as was said"
        return (dropped(said, field.name, many=many),)
    return ()


def _by_rows(n_drawn: int, given: Iterable[str]) -> list[str]:
    """Return which of the settings drawn rows say: all of one row, but for its spacing."""
    told = {"row_bearing_deg"} if n_drawn else set()
    if n_drawn >= _SEVERAL:
        told.add("row_spacing_m")
    return [name for name in given if name in told]


def _in_blocks(field: Field, given: Iterable[str]) -> tuple[ImportMessage, ...]:
    """Return what to say of settings that blocks have of their own."""
    from fieldmon.plot.block_layout import drawn_in  # noqa: PLC0415 - only with blocks

    found = []
    drawn = {block: _by_rows(len(drawn_in(field, block).geoms), given) for block in field.blocks}
    for name in given:
        own = [
            block.name or str(number)
            for number, block in enumerate(field.blocks, 1)
            if getattr(block, name, None) is not None or name in drawn[block]
        ]
        if own:
            said = worded(
                "The {setting} that was said is not used in {n} {n:block|blocks} with one of "
                "{n:its|their} own: {names}.",
                setting=_CALLED[name],
                n=len(own),
                names=first_few(own),
            )
            found.append(dropped(said, field.name))
    return tuple(found)


def _names(settings: Iterable[str]) -> str:
    return joined(", ", [_CALLED[name] for name in settings])
