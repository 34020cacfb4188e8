"""Which pests a file names, and the question which one is meant."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import ABSENT
from fieldmon.io.parse.pest_names import about_spellings, is_visit, usual_spellings
from fieldmon.io.parse.result_words import meaning
from fieldmon.io.parse.values import is_missing

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.import_report import ImportMessage


def one_pest(name: str, cells: Iterable[str]) -> tuple[dict[str, str], list[ImportMessage]]:
    """Return the usual spelling of the one pest that column `name` names, by every one in cells.

    And what was taken for another spelling of it. What says that there is none, a figure and a kind
    of visit name no pest.

    Raises
    ------
    ChoiceNeeded
        Where it names several: what was found is of one.
    """
    often = Counter(cells)
    spelt = usual_spellings({cell: n for cell, n in often.items() if _names_pest(cell)})
    kinds = sorted(set(spelt.values()))
    if len(kinds) < 2:
        return spelt, about_spellings(name, spelt)
    raise ChoiceNeeded(
        worded(
            "What was found must be of one pest, but column {name!r} names {n}: {shown}. Choose "
            "one, or let no column name pests (columns=species=): then all count as one.",
            name=name,
            n=len(kinds),
            shown=first_few(kinds, 5),
        ),
        "where",
        tuple(f"{name}={kind}" for kind in kinds),
    )


def _names_pest(cell: str) -> bool:
    is_figure = cell.replace(".", "", 1).isdecimal()
    return not (is_figure or is_missing(cell) or meaning(cell) == ABSENT or is_visit(cell))
