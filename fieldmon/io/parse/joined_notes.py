"""Notes of several people on one thing: their parts, each once, and together one note again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.io.parse.result_words import GONE, begins_gone

if TYPE_CHECKING:
    from collections.abc import Iterable

_BETWEEN = "; "


def parts(note: str) -> list[str]:
    """Return the parts of a note, each once, in order; that a plant is gone is one of them.

    Examples
    --------
    >>> parts("gone: cut; burnt; cut")
    ['gone', 'cut', 'burnt']
    """
    gone = begins_gone(note)
    rest = note.partition(":")[2] if gone else note
    each = (part.strip() for part in rest.split(_BETWEEN.strip()))
    return [*dict.fromkeys([*([GONE] if gone else []), *filter(None, each)])]


def note_of(said: Iterable[str]) -> str:
    """Return parts as one note, each once, so that it still says whether the plant is gone.

    Examples
    --------
    >>> note_of(["cut", "gone", "cut"])
    'gone: cut'
    """
    each = [*dict.fromkeys(said)]
    if GONE not in each:
        return _BETWEEN.join(each)
    rest = _BETWEEN.join(part for part in each if part != GONE)
    return f"{GONE}: {rest}" if rest else GONE


def joined_notes(notes: Iterable[str]) -> str:
    """Return notes as one, each part once, in their order; the first where no other adds to it."""
    first, *others = notes
    said = parts(first)
    more = [part for note in others for part in parts(note) if part not in said]
    return note_of([*said, *more]) if more else first


def in_both(one: str, other: str) -> str:
    """Return what is noted in either of two copies of a note, whichever is named first."""
    here, there = {*parts(one)}, {*parts(other)}
    if here == there:
        return max(one, other)
    if here <= there or there <= here:
        return one if there <= here else other
    return note_of(sorted(here | there))
