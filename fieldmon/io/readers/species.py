"""What to say where a file mixes species."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.infestation.observations import ABSENT
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful
from fieldmon.io.parse.result_words import meaning
from fieldmon.io.parse.values import is_missing

if TYPE_CHECKING:
    from collections.abc import Iterable


def species_in(cells: Iterable[str]) -> list[str]:
    """Return the species that cells name, each once; "none" is none."""
    return sorted(c for c in set(cells) if not is_missing(c) and meaning(c) != ABSENT)


def mixed_species(name: str, cells: Iterable[str]) -> list[ImportMessage]:
    """Return a doubt where the cells of column `name` hold several species, each to be chosen."""
    kinds = species_in(cells)
    if len(kinds) < 2:
        return []
    shown = first_few(kinds, 5)
    only = tuple(f"{name}={kind}" for kind in kinds)
    remedy = Remedy("where", only[0], worded("Only {species}", species=kinds[0]), only[1:])
    return [
        doubtful(worded("{n} species are mixed: {shown}.", n=len(kinds), shown=shown), name, remedy)
    ]
