"""The file that pages are written to: fpdf2's, with what it gets wrong put right."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from fpdf import FPDF
from fpdf.enums import TextDirection

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Any

    from fpdf.line_break import Fragment

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

    def _render_styled_text_line(self, *told: Any, **also: Any) -> bool:  # noqa: ANN401 - fpdf2's
        """Write a line in the font that is set, which the page is told of first.

        fpdf2 tells it where a line begins in another font inside what it takes back after it, and
        believes it told: later lines would have any font (2.8.9).
        """
        if self.page and self.current_font and not self.current_font_is_set_on_page:
            self._out(self._set_font_for_page(self.current_font, self.font_size_pt))
        return super()._render_styled_text_line(*told, **also)

    def _preload_bidirectional_text(self, text: str, markdown: bool) -> Sequence[Fragment]:  # noqa: FBT001 - fpdf2's
        """Turn a text as its page is read, not as its first word is; figures alone never turn."""
        turned = any(unicodedata.bidirectional(one) in _RIGHT_TO_LEFT for one in text)
        shaping = self.text_shaping
        if shaping:
            shaping["direction"] = (
                TextDirection.RTL if self._right_to_left and turned else TextDirection.LTR
            )
        return super()._preload_bidirectional_text(text, markdown)

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


def _has_mark(before: Fragment, after: Fragment) -> bool:
    """Tell whether a run ends in a mark over a letter, or the next one begins with one."""
    beside = before.characters[-1:] + after.characters[:1]
    return any(unicodedata.category(one) == "Mn" for one in beside)
