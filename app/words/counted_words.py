"""Nouns that the library writes for any number, "record(s)", said for the number that is there.

Commands print them as they are; a page says "1 record lies" and "3 records lie".
"""

from __future__ import annotations

import re

#: what is said of one, by what is said of several
VERBS = {
    "are": "is", "were": "was", "have": "has", "do": "does", "lie": "lies", "say": "says",
    "name": "names", "give": "gives", "repeat": "repeats", "hold": "holds", "state": "states",
    "pass": "passes", "part": "parts", "stand": "stands",
}  # fmt: skip
_MANY = "(s)"
# a number, perhaps of how many, perhaps a word or two; the noun; perhaps what is said of it
_COUNTED = re.compile(
    r"(?P<n>\d[\d,.]*)(?P<of> of (?P<all>\d[\d,.]*))?(?P<between>(?: [^\W\d]+){0,2}?)"
    r" (?P<noun>[^\W\d]+)\(s\)(?:(?P<that> that)? (?P<verb>[a-z]+)\b)?"
)
# no number: what is named after it tells
_NAMED = re.compile(r"(?P<noun>\b[^\W\d]+)\(s\)(?P<names>[^.:;]*)")
# one thing, of which more is said further on
_WERE = re.compile(r"((?<![\d.,])\b1(?: of \d[\d,.]*)? [^\W\d][^.;:]*?)\bwere\b")


def in_numbers(text: str, language: str) -> str:
    """Return a text without such nouns, where the language forms them with an s.

    Examples
    --------
    >>> in_numbers("1 record(s) lie on no plant; 3 line(s) were left out.", "en")
    '1 record lies on no plant; 3 lines were left out.'
    """
    if _MANY not in text:
        return text
    if language == "en":
        return _WERE.sub(r"\1was", _NAMED.sub(_named, _COUNTED.sub(_counted, text)))
    # verbs of other languages are not known here: one thing is left as it was
    return _COUNTED.sub(_several, text) if language == "es" else text


def _counted(found: re.Match[str]) -> str:
    one = found["n"] == "1"
    noun = found["noun"] if (found["all"] or found["n"]) == "1" else f"{found['noun']}s"
    said = f"{found['n']}{found['of'] or ''}{found['between']} {noun}"
    verb = found["verb"]
    if verb is None:
        return said
    return f"{said}{found['that'] or ''} {VERBS.get(verb, verb) if one else verb}"


def _several(found: re.Match[str]) -> str:
    return found[0] if found["n"] == "1" else found[0].replace(_MANY, "s")


def _named(found: re.Match[str]) -> str:
    several = ", " in found["names"] or " and " in found["names"]
    return f"{found['noun']}{'s' if several else ''}{found['names']}"
