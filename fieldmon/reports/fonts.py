"""Fonts that go into a file: of each no more than the letters that are written.

Open Sans (Latin, Greek, Cyrillic, Hebrew, Vietnamese) and Noto Sans Arabic may be given away inside
a document: both are under the SIL Open Font License 1.1.
"""

from __future__ import annotations

import io
import unicodedata
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

#: package and file of each font, the first one that has a letter writes it
_FONTS = {
    "open": ("fontpkg_open_sans", "OpenSans[wdth,wght].ttf"),
    "arabic": ("fontpkg_noto_sans_arabic", "NotoSansArabic[wdth,wght].ttf"),
}
_WEIGHTS = {"": 400, "B": 700}
# stands for what no font has
_MISSING = "?"
_TIED = "\u00a0"
# signs that the fonts lack, and what is written for them: geresh and gershayim of Hebrew
_ALIKE = str.maketrans({"\u05f3": "'", "\u05f4": '"'})


@dataclass(frozen=True)
class FontFile:
    """A font cut down to what is written: its family, its style ("" or "B") and its bytes."""

    family: str
    style: str
    data: bytes


@dataclass(frozen=True)
class FontSet:
    """The fonts for some texts, and the letters that none of them has."""

    fonts: tuple[FontFile, ...]
    missing: frozenset[str]

    @classmethod
    def of(cls, texts: Iterable[str]) -> FontSet:
        """Return the fonts that write these texts."""
        written = (text.translate(_ALIKE) for text in texts)
        letters = {one for text in written for one in text if _is_seen(one)}
        letters |= {_MISSING, _TIED, " "}
        fonts, left = [], {*letters}
        for family in _FONTS:
            # what joins letters must come from the font of the letters
            own = frozenset(left & _letters_of(family))
            if own - {" "}:
                fonts += [
                    FontFile(family, style, _cut(family, weight, own | {" "}))
                    for style, weight in _WEIGHTS.items()
                ]
            left -= own
        return cls(tuple(fonts), frozenset(left))

    def printable(self, text: str) -> str:
        """Return a text with a sign in place of what no font has; no line ends before a %."""
        known = text.translate(_ALIKE)
        shown = "".join(_MISSING if one in self.missing else one for one in known)
        return shown.replace(" %", f"{_TIED}%")


def _is_seen(letter: str) -> bool:
    """Tell whether a letter leaves a mark; what steers direction and joining leaves none."""
    return unicodedata.category(letter) not in {"Cf", "Cc"}


def _path(family: str) -> str:
    package, name = _FONTS[family]
    return str(files(package) / "files" / name)


@cache
def _letters_of(family: str) -> frozenset[str]:
    from fontTools.ttLib import TTFont  # noqa: PLC0415 - a PDF alone needs it

    with TTFont(_path(family), lazy=True) as font:
        return frozenset(chr(code) for code in font.getBestCmap())


@cache
def _cut(family: str, weight: int, letters: frozenset[str]) -> bytes:
    """Return a font of one weight with these letters and their ligatures."""
    from fontTools.subset import Options, Subsetter  # noqa: PLC0415 - as above
    from fontTools.ttLib import TTFont  # noqa: PLC0415
    from fontTools.varLib.instancer import instantiateVariableFont  # noqa: PLC0415

    options = Options()
    options.layout_features, options.hinting, options.notdef_outline = ["*"], False, True
    file = io.BytesIO()
    # the font's own date: the same letters are the same bytes
    with TTFont(_path(family), lazy=True, recalcTimestamp=False) as font:
        cutter = Subsetter(options)
        cutter.populate(unicodes=[ord(one) for one in letters])
        cutter.subset(font)
        instantiateVariableFont(font, {"wght": weight, "wdth": 100}, inplace=True)
        font.save(file)
    return file.getvalue()
