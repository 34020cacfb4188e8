"""Bytes to text by the bytes' own evidence, whatever the file says about itself."""

from __future__ import annotations

import codecs
import re
from typing import TYPE_CHECKING

from fieldmon.errors import ChoiceNeeded
from fieldmon.geodata.findings import Finding, Remedy, guessed

if TYPE_CHECKING:
    from collections.abc import Sequence

#: offered where the text is not UTF-8
ENCODINGS = ("cp1255", "cp862", "cp1252")
_BOMS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
# Hebrew comes in whole words: runs of letters, which lie at E0-FA (Windows) or 80-9A (DOS)
_RUN_1255 = re.compile(rb"[\xe0-\xfa]{2,}")
_RUN_862 = re.compile(rb"[\x80-\x9a]{2,}")
_HIGH = re.compile(rb"[\x80-\xff]")


def decode(data: bytes, encoding: str | None = None) -> tuple[str, list[Finding]]:
    """Return text and what was found about how it is written."""
    if encoding is not None:
        return _as_told(data, encoding), []
    for bom, name in _BOMS:
        if data.startswith(bom):
            return data.decode(name, errors="replace"), []
    try:
        return data.decode("utf-8"), []
    except UnicodeDecodeError:
        best = evidence([data])
        return decode_with(data, best), [_guess(best)]


def decode_with(data: bytes, encoding: str) -> str:
    """Return text; a byte that the encoding does not know becomes a mark, not an error."""
    return data.decode(encoding, errors="replace")


def evidence(samples: Sequence[bytes]) -> str:
    """Return which encoding other than UTF-8 the bytes speak for."""
    high = sum(len(_HIGH.findall(s)) for s in samples)
    windows = sum(len(run) for s in samples for run in _RUN_1255.findall(s))
    dos = sum(len(run) for s in samples for run in _RUN_862.findall(s))
    if high and max(windows, dos) >= 0.6 * high:
        return "cp1255" if windows >= dos else "cp862"
    return "cp1252"


def _guess(best: str) -> Finding:
    other = next(name for name in ENCODINGS if name != best)
    return guessed(
        f"The text is not UTF-8; by its letters it was read as {best}.",
        remedy=Remedy("encoding", other, f"Read as {other}"),
    )


def _as_told(data: bytes, encoding: str) -> str:
    try:
        return data.decode(encoding)
    except LookupError:
        raise ChoiceNeeded(
            f"The encoding must be one that Python knows, but {encoding!r} is not. Choose one.",
            "encoding",
            ("utf-8", *ENCODINGS),
        ) from None
    except UnicodeDecodeError as bad:
        raise ChoiceNeeded(
            f"The text must be readable as {encoding}, but byte {bad.start} is not. "
            "Choose another encoding.",
            "encoding",
            tuple(name for name in ("utf-8", *ENCODINGS) if name != encoding),
        ) from None
