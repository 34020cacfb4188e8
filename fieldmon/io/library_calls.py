"""What all calls of the library do: look at the file, take options, answer questions, warn.

Nobody is asked here as on a page: a question is an error that says which argument answers it.
"""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldmon.compute.arguments import must_be, must_be_name_of_file
from fieldmon.errors import ChoiceNeeded, ImportDoubt
from fieldmon.io.import_report import Severity
from fieldmon.io.options import Upload, as_texts

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from fieldmon.io.import_report import ImportMessage

#: questions that another file answers
_OTHER_FILES = {
    "kind": "Give points as plants=FILE, and lines as rows=FILE or paths=FILE.",
    "plots": "Give the file of the plots first.",
    "plants": "Give the plants as plants=FILE.",
}
#: options of the first file that count for plants measured on its plot, too
_OF_PLANTS = {("plants", "doubles"), ("plants", "far")}
_DOUBTS = (Severity.GUESSED, Severity.DROPPED, Severity.DOUBTFUL)


def must_be_file(source: Any, what: str = "A file") -> None:  # noqa: ANN401 - anything
    """Raise `SettingError` unless this is a file: its path, or what was uploaded."""
    uploads = isinstance(source, tuple) and len(source)
    frame = _written_as(source)
    for one in source if uploads else (source,):
        must_be(
            f"{what} must be given by its path", one, Upload if uploads else (str, Path, Upload),
            frame or 'Give "estate.zip", or Path("estate.zip").',
        )  # fmt: skip
    if not uploads:
        must_be_name_of_file(what, source)


def _written_as(source: Any) -> str:  # noqa: ANN401 - anything
    """Return how a frame of GeoPandas, pandas or polars is given; empty: it is none."""
    if hasattr(source, "to_file"):
        return 'Write it to a file first: frame.to_file("table.gpkg").'
    if hasattr(source, "to_csv"):
        return 'Write it to a file first: frame.to_csv("table.csv", index=False).'
    if hasattr(source, "write_csv"):
        return 'Write it to a file first: frame.write_csv("table.csv").'
    return ""


@contextmanager
def answered(role: str = "") -> Iterator[None]:
    """Say with a question how to answer it, where the file of this role asks.

    Options are those of that file, but for a few that files of plants have too.
    """
    try:
        yield
    except ChoiceNeeded as question:
        said = f"{question} {_answer(question, role)}".rstrip()
        raise ChoiceNeeded(said, question.option, question.choices, question.role) from None


def _answer(question: ChoiceNeeded, role: str) -> str:
    """Return what to write, with the first of the choices; empty where no option answers."""
    option = question.option
    if option in _OTHER_FILES:
        return _OTHER_FILES[option]
    if question.role not in {"", role} and (question.role, option) not in _OF_PLANTS:
        return ""
    first = question.choices[0] if question.choices else "..."
    column, _, named = first.partition("=")
    told = {column: named} if option == "columns" else first
    return f"Answer with {option}={told!r}, for instance."


def chosen(options: Any, more: dict[str, object]) -> Any:  # noqa: ANN401 - options of any kind
    """Return options with those that a call names besides; lists and dictionaries as texts."""
    for name, value in more.items():
        for said in as_texts(name, value):
            options = options.choose(name, said)
    return options


def warn_of(messages: Iterable[ImportMessage]) -> None:
    """Warn the caller of the caller of every doubt."""
    for message in messages:
        if message.severity in _DOUBTS:
            warnings.warn(str(message), ImportDoubt, stacklevel=3)
