"""Bytes to text by the bytes' own evidence, whatever the file says about itself."""

from __future__ import annotations

import codecs
import re
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import ImportMessage, Remedy, guessed, repaired

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

#: offered where the text is not UTF-8
ENCODINGS = ("cp1255", "cp862", "cp1252")
_BOMS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
# Hebrew comes in whole words: runs of letters, which lie at E0-FA (Windows) or 80-9A (DOS), where
# western text has single accented letters among plain ones
_WORD = re.compile(rb"[A-Za-z\x80-\xff]*[\x80-\xff][A-Za-z\x80-\xff]*")
_WINDOWS = re.compile(rb"[\xe0-\xfa]{2,}")
_DOS = re.compile(rb"[\x80-\x9a]{2,}")
_ENOUGH = 0.6
#: what a shapefile's .cpg says about most files, true or not
_WESTERN = frozenset({"cp1252", "iso8859-1", "ascii", "iso8859-15", "utf-8"})


def decode(data: bytes, encoding: str | None = None) -> tuple[str, list[ImportMessage]]:
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
        return data.decode(best, errors="replace"), [_guess(best)]


def evidence(samples: Sequence[bytes]) -> str:
    """Return which encoding other than UTF-8 the bytes speak for."""
    words = [word for sample in samples for word in _WORD.findall(sample)]
    windows = sum(bool(_WINDOWS.fullmatch(word)) for word in words)
    dos = sum(bool(_DOS.fullmatch(word)) for word in words)
    if max(windows, dos) >= _ENOUGH * max(len(words), 1):
        return "cp1255" if windows >= dos else "cp862"
    return "cp1252"


class Decoder:
    """How all text of one shapefile is written, found from all of it together.

    Parameters
    ----------
    samples
        Every name and value as bytes.
    stated
        What the .cpg says; None without one.
    told
        The encoding chosen by hand, or None.
    """

    def __init__(self, samples: Iterable[bytes], stated: str | None, told: str | None) -> None:
        telling = [s for s in set(samples) if not s.isascii()]
        self.messages: list[ImportMessage] = []
        if told is not None:
            self.encoding = told
            for sample in telling:
                _as_told(sample, told)
            return
        self.encoding = self._found(telling, _codec(stated))

    def __call__(self, data: bytes) -> str:
        """Return text; a letter cut in half at the end of a field is left out."""
        if self.encoding == "utf-8":
            return data.decode("utf-8", errors="ignore")
        return data.decode(self.encoding, errors="replace")

    def _found(self, telling: list[bytes], stated: str | None) -> str:
        if not telling:
            return stated or "utf-8"
        if all(_is_utf8(sample) for sample in telling):
            if stated not in {None, "utf-8"}:
                said = worded(
                    "The .cpg file says {stated}, but the text is UTF-8 and was read so.",
                    stated=stated,
                )
                self.messages.append(repaired(said))
            return "utf-8"
        if stated is not None and stated not in _WESTERN and _fits(telling, stated):
            return stated
        best = evidence(telling)
        if best == "cp1252" and stated in {"cp1252", "iso8859-1"}:
            return best
        self.messages.append(_guess(best, stated))
        return best


def _codec(stated: str | None) -> str | None:
    """Return the codec that a .cpg names in one of many ways, or None."""
    if stated is None:
        return None
    name = stated.strip().lower().removeprefix("ansi").removeprefix("oem").strip(" _-")
    name = {"88591": "iso8859-1", "65001": "utf-8"}.get(name, name)
    for candidate in (name, f"cp{name}"):
        try:
            return codecs.lookup(candidate).name
        except (LookupError, ValueError):
            continue
    return None


def _is_utf8(data: bytes) -> bool:
    try:
        codecs.getincrementaldecoder("utf-8")().decode(data)  # may stop inside a letter
    except UnicodeDecodeError:
        return False
    return True


def _fits(samples: list[bytes], encoding: str) -> bool:
    try:
        return all(isinstance(sample.decode(encoding), str) for sample in samples)
    except (UnicodeDecodeError, LookupError):
        return False


def _guess(best: str, stated: str | None = None) -> ImportMessage:
    other, *more = (name for name in ENCODINGS if name != best)
    return guessed(
        worded("The text is not UTF-8; by its letters it was read as {best}.", best=best)
        if not stated
        else worded(
            "The .cpg file says {stated}, but the text is not UTF-8; by its letters it was read "
            "as {best}.",
            stated=stated,
            best=best,
        ),
        remedy=Remedy("encoding", other, worded("Read as {other}", other=other), tuple(more)),
    )


def _as_told(data: bytes, encoding: str) -> str:
    try:
        return data.decode(encoding)
    except (UnicodeDecodeError, ValueError):
        raise ChoiceNeeded(
            worded(
                "The text must be readable as {encoding}, but it is not. Choose another encoding.",
                encoding=encoding,
            ),
            "encoding",
            tuple(name for name in ("utf-8", *ENCODINGS) if name != encoding),
        ) from None
    except (LookupError, TypeError):
        raise ChoiceNeeded(
            worded(
                "The encoding must be one that Python knows, but {encoding!r} is not. Choose one.",
                encoding=encoding,
            ),
            "encoding",
            ("utf-8", *ENCODINGS),
        ) from None
