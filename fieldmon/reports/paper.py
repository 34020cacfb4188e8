"""The file that pages are written to: fpdf2's, with what it gets wrong put right."""

from __future__ import annotations

import unicodedata
from itertools import groupby
from typing import TYPE_CHECKING, Any

from fpdf import FPDF
from fpdf.bidi import BidiParagraph
from fpdf.enums import TextDirection
from fpdf.fonts import TTFFont

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fpdf.line_break import Fragment, TextLine

_RIGHT_TO_LEFT = {"R", "AL"}


class Paper(FPDF):
    """A PDF for texts in several scripts.

    Parameters
    ----------
    size
        Width and height, millimetres.
    right_to_left
        Whether it is read from the right.
    """

    def __init__(self, size: tuple[float, float], *, right_to_left: bool = False) -> None:
        super().__init__(format=size)
        self._right_to_left = right_to_left

    def add_font(self, *told: Any, **also: Any) -> None:  # noqa: ANN401 - fpdf2's
        """Add a font that remembers how wide texts are in it."""
        super().add_font(*told, **also)
        for font in self.fonts.values():
            if isinstance(font, TTFFont):
                font.__class__ = _Font

    def _render_styled_text_line(self, text_line: TextLine, *told: Any, **also: Any) -> bool:  # noqa: ANN401 - fpdf2's
        """Write a line in the font that is set, which the page is told of first.

        fpdf2 tells it where a line begins in another font inside what it takes back after it, and
        believes it told: later lines would have any font (2.8.9).
        """
        if self.page and self.current_font and not self.current_font_is_set_on_page:
            self._out(self._set_font_for_page(self.current_font, self.font_size_pt))
        line = text_line._replace(fragments=_turnable(text_line.fragments))
        return super()._render_styled_text_line(line, *told, **also)

    def _preload_bidirectional_text(self, text: str, markdown: bool) -> Sequence[Fragment]:  # noqa: FBT001 - fpdf2's
        """Return the runs of a text, turned as its page is read, not as its first word is.

        Figures alone never turn. fpdf2 takes a number among words read from the right for one
        with the words after it; here runs part by level.
        """
        shaping = self.text_shaping
        if not shaping:
            return super()._preload_bidirectional_text(text, markdown)
        turned = any(unicodedata.bidirectional(one) in _RIGHT_TO_LEFT for one in text)
        base = TextDirection.RTL if self._right_to_left and turned else TextDirection.LTR
        shaping["paragraph_direction"] = base
        letters = BidiParagraph(text=text, base_direction=base, preserve_bn_chars=True).characters
        runs: list[Fragment] = []
        for level, of in groupby(letters, key=lambda one: one.embedding_level):
            shaping["fragment_direction"] = TextDirection.RTL if level % 2 else TextDirection.LTR
            shaping["level"] = level
            runs += self._preload_font_styles("".join(one.character for one in of), markdown)
        return tuple(runs)

    def _parse_chars(self, text: str, markdown: bool, **also: Any) -> Iterator[Fragment]:  # noqa: ANN401, FBT001 - fpdf2's
        """Yield runs of one font; a mark over a letter does not part its word."""
        last = None
        for one in super()._parse_chars(text, markdown, **also):
            if last is not None and last.font is one.font and _has_mark(last, one):
                last.characters += one.characters
                continue
            if last is not None:
                yield last
            last = one
        if last is not None:
            yield last


class _Font(TTFFont):
    """A font that remembers how wide texts are in it.

    fpdf2 asks again for all runs of a line with each letter that it adds.
    """

    __slots__ = ()

    def shaped_text_width(
        self, text: str, font_size_pt: float, text_shaping_params: dict[str, Any] | None
    ) -> tuple[int, float]:
        """Return number and width of the glyphs of a text, worked out once."""
        told = text_shaping_params or {}
        given = map(told.get, ("fragment_direction", "script", "language"))
        asked = (text, font_size_pt, *given, *told.get("features", {}).items())
        # only this part of a font takes what it was not made for
        known: dict[object, tuple[int, float]] = self.hbfont.__dict__.setdefault("known", {})
        if asked not in known:
            known[asked] = super().shaped_text_width(text, font_size_pt, text_shaping_params)
        return known[asked]


def _has_mark(before: Fragment, after: Fragment) -> bool:
    """Tell whether a run ends in a mark over a letter, or the next one begins with one."""
    beside = before.characters[-1:] + after.characters[:1]
    return any(unicodedata.category(one) == "Mn" for one in beside)


def _turnable(runs: Sequence[Fragment]) -> list[Fragment]:
    """Return the runs of a line in an order that fpdf2 turns into the one that Unicode asks for."""
    levels = [(one.text_shaping_parameters or {}).get("level", 0) for one in runs]
    seen = list(range(len(runs)))
    # rule L2: from the highest level to the lowest odd one, all that is as high is turned about
    for least in range(max(levels, default=0), 0, -1):
        parts = groupby(seen, key=lambda k, least=least: levels[k] >= least)  # type: ignore[misc]
        seen = [k for high, of in parts for k in ([*of][::-1] if high else of)]
    groups = [(odd, [*of]) for odd, of in groupby(seen, key=lambda k: levels[k] % 2)]
    if runs and runs[0].paragraph_direction == TextDirection.RTL:
        groups.reverse()
    return [runs[k] for odd, of in groups for k in (of[::-1] if odd else of)]
