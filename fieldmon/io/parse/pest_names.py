"""One pest, however its name is written."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter, defaultdict
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.io.import_report import ImportMessage, guessed

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

# over and under letters of Latin, Greek and Cyrillic: arana is araña
_ACCENTS = re.compile(r"[\u0300-\u036f]")
_BETWEEN = re.compile(r"[\s._-]+")
# before NFKD, which makes an accent of one of them
_APOSTROPHES = str.maketrans("\u2019\u2018\u02bc\u00b4`\u2032", "'" * 6)
# whiteflies and whitefly
_FLIES = re.compile(r"(?<=[^\W\d_]{2})ies\b")
# mites and mite, arañas rojas and araña roja, pulgones and pulgón, Milben and Milbe; not
# Tetranychus, occidentalis and rosae
_PLURAL = re.compile(r"(?<=[^\W\d_]{3})(?:(?<![aeiou])e[ns]?|(?<![isu])s)\b")
# whichever it is of a genus: Tetranychus sp., Tetranychus spp. and Tetranychus; sp. 1 is one
_ANY = re.compile(r"(?<=\w) spp?$")
# kinds of visits, which a German column "Art" may hold as well as species
_VISIT = re.compile(
    r"kontroll|begehung|bonitur|stichprobe|besuch|routine|inspektion|behandlung|überwachung"
)


def pest_key(name: str) -> str:
    """Return what all ways of writing one pest have in common: ``spider mit``."""
    decomposed = unicodedata.normalize("NFKD", name.translate(_APOSTROPHES))
    words = _BETWEEN.sub(" ", _ACCENTS.sub("", decomposed).casefold()).strip()
    return _PLURAL.sub("", _FLIES.sub("y", _ANY.sub("", words)))


def is_visit(name: str) -> bool:
    """Return whether a word is no pest's name, but a kind of visit: ``Nachkontrolle``."""
    return bool(_VISIT.search(unicodedata.normalize("NFKC", name).casefold()))


def usual_spellings(names: Iterable[str] | Mapping[str, int]) -> dict[str, str]:
    """Return the spelling of each pest that is most often written, by every one that is.

    `names` are all that are written, or how often each is.
    """
    often = Counter(names)
    spelt = defaultdict[str, list[str]](list)
    for name in often:
        spelt[pest_key(name)].append(name)
    return {
        name: max(alike, key=lambda one: often[one]) for alike in spelt.values() for name in alike
    }


def about_spellings(column: str, usual: dict[str, str]) -> list[ImportMessage]:
    """Return what pests of a column are taken for one that are written in several ways."""
    others = defaultdict[str, list[str]](list)
    for name, taken in usual.items():
        if name != taken:
            others[taken].append(name)
    return [
        guessed(
            worded(
                "{alike} and {pest} were taken for one pest.",
                alike=first_few(sorted(alike), 5),
                pest=pest,
            ),
            column,
        )
        for pest, alike in others.items()
    ]
