"""What to say where a file mixes species."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.infestation.observations import ABSENT
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful
from fieldmon.io.parse.pest_names import about_spellings, usual_spellings
from fieldmon.io.parse.result_words import meaning
from fieldmon.io.parse.values import is_missing

if TYPE_CHECKING:
    from collections.abc import Iterable


def spelt_in(cells: Iterable[str]) -> dict[str, str]:
    """Return the usual spelling of each species, by every one in cells; "none" is none."""
    often = Counter(cells)
    named = (c for c in often if not is_missing(c) and meaning(c) != ABSENT)
    return usual_spellings({c: often[c] for c in named})


def species_in(cells: Iterable[str]) -> list[str]:
    """Return the species that cells name, each once, however it is spelt; "none" is none."""
    return sorted(set(spelt_in(cells).values()))


def mixed_species(name: str, cells: Iterable[str]) -> list[ImportMessage]:
    """Return a doubt where the cells of column `name` hold several species, each to be chosen.

    What was taken for another spelling of one is said.
    """
    spelt = spelt_in(cells)
    kinds, said = sorted(set(spelt.values())), about_spellings(name, spelt)
    if len(kinds) < 2:
        return said
    shown = first_few(kinds, 5)
    only = tuple(f"{name}={kind}" for kind in kinds)
    remedy = Remedy("where", only[0], worded("Only {species}", species=kinds[0]), only[1:])
    mixed = worded("{n} species are mixed: {shown}.", n=len(kinds), shown=shown)
    return [*said, doubtful(mixed, name, remedy)]
