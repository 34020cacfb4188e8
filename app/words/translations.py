"""The texts of a language, read once from its file. No Streamlit in here."""

from __future__ import annotations

import gettext
from functools import cache
from io import BytesIO
from pathlib import Path

#: where the files of all languages are
FOLDER = Path(__file__).with_name("languages")


@cache
def catalogue_of(language: str) -> Catalogue:
    """Return a language's texts, read once."""
    from babel.messages.mofile import write_mo  # noqa: PLC0415 - who reads English needs none
    from babel.messages.pofile import read_po  # noqa: PLC0415

    written = BytesIO()
    with (FOLDER / f"{language}.po").open("rb") as file:
        write_mo(written, read_po(file, locale=language))
    written.seek(0)
    found = Catalogue(written)
    found.add_fallback(_Unknown())
    return found


class Catalogue(gettext.GNUTranslations):
    """A language's texts."""

    def words(self) -> list[str]:
        """Return all of them."""
        texts_: dict[object, str] = self._catalog  # type: ignore[attr-defined]
        return [*texts_.values()]

    def words_in(self, context: str) -> list[str]:
        """Return the English of the texts of a context that have one form."""
        texts_: dict[object, str] = self._catalog  # type: ignore[attr-defined]
        before = f"{context}\x04"
        keys = (key for key in texts_ if isinstance(key, str))
        return [key.removeprefix(before) for key in keys if key.startswith(before)]


class _Unknown(gettext.NullTranslations):
    """Says nothing of what a catalogue has no words for."""

    def pgettext(self, context: str, message: str) -> str:  # noqa: ARG002 - as gettext asks
        return ""

    def npgettext(self, context: str, msgid1: str, msgid2: str, n: int) -> str:  # noqa: ARG002
        return ""
