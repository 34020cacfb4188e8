"""Columns that count pests beside the one that is read: eggs beside adults, count2 beside count."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.infestation.records import ABSENT
from fieldmon.io.formats.layer import text
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful
from fieldmon.io.parse.columns import find, is_id, is_position, is_score, is_time, plain, recognised
from fieldmon.io.parse.values import counted, decimal_mark

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.formats.layer import Layer
    from fieldmon.io.options import RecordOptions

# English; German, Dutch; Spanish; French; Italian, Portuguese; Hebrew; Arabic
_COUNTED = """
egg eggs nymph nymphs protonymphs deutonymphs larva larvae larvas pupa pupae pupas adult adults male
males female females mite mites pests insect insects aphid aphids thrips whitefly whiteflies motile
motiles immature immatures juvenile juveniles
ei eier eizahl larve larven nymphe nymphen puppe puppen adulte adulten weibchen männchen milbe
milben milbenzahl schädlinge blattläuse eieren mijten
huevo huevos ninfa ninfas adulto adultos hembra hembras macho machos ácaro ácaros insectos
oeuf oeufs œuf œufs nymphes larves adultes femelle femelles mâle mâles acarien acariens insectes
uova ninfe pupe adulti femmine maschi acari insetti ovos fêmeas
ביצים נימפות זחלים גלמים בוגרים נקבות זכרים אקריות
بيض بيوض حوريات يرقات عذارى بالغات إناث ذكور أكاروسات عناكب
"""
# what is counted, or looked at, and is no pest
_OTHERS = """
predator predators predatory beneficial beneficials parasitoid parasitoids raubmilben raubmilbe
nützlinge depredadores prédateurs leaf leaves blatt blätter hoja hojas feuille feuilles tree trees
plant plants vine vines row rows id code
photo photos image images scan scans visit visits trap traps
percent pct prozent area
"""
_SIDES = "upper lower top bottom left right inner outer side oben unten links rechts a b c"


_WORDS, _NO_PESTS = frozenset(map(plain, _COUNTED.split())), frozenset(map(plain, _OTHERS.split()))
_PLACES = frozenset(_SIDES.split())
_WORD = re.compile(r"[^\W\d_]+")
_HUMP = re.compile(r"(?<=[a-z])(?=[A-Z])")


def counts_pests(name: str) -> bool:
    """Return whether a column counts pests by its name: count2, eggs, nMales, mites_upper."""
    if is_time(name) or is_score(name) or is_position(name) or is_id(name, ()):
        return False
    if recognised([name]):
        return find("count", [name]) is not None
    words = [
        plain(word) for word in _WORD.findall(_HUMP.sub(" ", unicodedata.normalize("NFC", name)))
    ]
    if _NO_PESTS.intersection(words):
        return False
    if _WORDS.intersection(words):
        return True
    whole = [word for word in words if word not in _PLACES]
    return bool(whole) and find("count", ["".join(whole)]) is not None


class OtherCounts(NamedTuple):
    """What to say of counts that are not read, and why rows are doubtful ``(n,)``."""

    messages: list[ImportMessage]
    doubt: NDArray[np.str_]


def about_other_counts(
    layer: Layer,
    options: RecordOptions,
    taken: str | None,
    used: Iterable[str | None],
    result: NDArray[np.int8],
) -> OtherCounts:
    """Return what to say of columns that count pests and are not read.

    Parameters
    ----------
    layer
        All records.
    options
        How they are read. A column of counts named by hand is no question any more.
    taken
        The column of counts that is read; None: there is none.
    used
        All columns that are read.
    result
        ``(n,)`` what each row says was found.

    Raises
    ------
    ChoiceNeeded
        Where a row would be clean while another column counts pests in it.
    """
    doubt = np.full(len(layer), "", dtype=object)
    others = _others(layer, options, {taken, *used})
    read = None if taken is None else _numbers(layer, taken, options.decimal)
    if read is not None and others and _adds_up(read, others):
        return OtherCounts([], doubt.astype(np.str_))
    messages = []
    for name, number in others.items():
        against = (result == ABSENT) & (number > 0)
        if against.any() and options.column("count") is None:
            raise ChoiceNeeded(
                worded(
                    "{n} {n:record|records} of {file} would be clean, but column {name!r} counts "
                    "pests there. Say which column the counts are in; to count all of them, add "
                    "them up in one.",
                    n=int(against.sum()),
                    file=layer.name,
                    name=name,
                ),
                "columns",
                tuple(f"count={one}" for one in (taken, *others) if one is not None),
            )
        doubt[against] = worded("it is clean, but column {name!r} counts pests there", name=name)
        messages.append(_not_used(name, taken))
    return OtherCounts(messages, doubt.astype(np.str_))


def _not_used(name: str, taken: str | None) -> ImportMessage:
    """Return that a column of counts is not used, and how it would be."""
    said = (
        worded("It seems to count pests, but is not used: no column of counts was named.")
        if taken is None
        else worded(
            "It seems to count pests, but is not used: counts are those of {taken!r}. To count "
            "both, add them up in one column.",
            taken=taken,
        )
    )
    label = worded("Take the counts from {name!r}", name=name)
    return doubtful(said, name, Remedy("columns", f"count={name}", label))


def _others(
    layer: Layer, options: RecordOptions, used: set[str | None]
) -> dict[str, NDArray[np.float64]]:
    """Return the counts ``(n,)`` of the columns that count pests, are not read and hold any."""
    named = options.named_columns
    names = [n for n in layer.columns if n not in used | named and counts_pests(n)]
    numbers = {name: _numbers(layer, name, options.decimal) for name in names}
    return {name: number for name, number in numbers.items() if (number > 0).any()}


def _numbers(layer: Layer, name: str, decimal: str | None) -> NDArray[np.float64]:
    cells = [text(v) for v in layer.column(name)]
    mark = decimal or decimal_mark(cells) or "."
    known = {cell: counted(cell.removeprefix("+"), mark).number for cell in set(cells)}
    return np.array([known[cell] for cell in cells], dtype=np.float64)


def _adds_up(read: NDArray[np.float64], others: dict[str, NDArray[np.float64]]) -> bool:
    """Return whether the counts that are read are the sum of all others, or the same as each."""
    each = np.nan_to_num(np.array(list(others.values())))
    read = np.nan_to_num(read)
    return bool((each.sum(axis=0) == read).all() or (each == read).all())
