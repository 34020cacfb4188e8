"""What an answer about a file is called. No Streamlit in here."""

from __future__ import annotations

from fieldmon.infestation.inspections import CLEAN, FOUND
from fieldmon.io.parse.result_words import words_in

from . import texts

# options that take words for a result
_RESULTS = {"found": FOUND, "clean": CLEAN}


def in_short(answer: str, option: str) -> str:
    """Return an answer to an import's question in a grower's words.

    Examples
    --------
    >>> str(in_short("present=", "columns")), in_short("plot=North", "where")
    ('Every record is a find', 'plot: North')
    """
    if option == "outline" and answer == "yes":
        return texts.ANSWER_OUTLINE
    if option in _RESULTS:
        return f"{', '.join(words_in(answer))}: {texts.HISTORY_RESULTS[_RESULTS[option]]}"
    key, is_pair, value = answer.partition("=")
    if not is_pair or option not in {"columns", "where"}:
        return answer
    if option == "where":
        return f"{key}: {value}"
    if not value and key in texts.ANSWER_NO_COLUMN:
        return texts.ANSWER_NO_COLUMN[key]
    said = texts.ANSWER_COLUMNS.get(key)
    return said.format(name=texts.isolated(value)) if said and value else value or answer
