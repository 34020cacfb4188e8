"""What there is to translate, and the files that hold it: ``python -m app.words.catalogues``.

The command writes each language's file anew: new texts with no translation yet, gone ones left
out, all others as they were. A translator needs nothing but that file.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path
from string import Formatter
from typing import TYPE_CHECKING, Any

from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po, write_po

import fieldmon
from fieldmon.compute.units import IN_UNIT
from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.readers.pest_file import shipped_words
from fieldmon.reports import words as report_words
from fieldmon.samplers import of_equal_times

from . import texts
from .language import DRAFTS, ENGLISH, FOLDER, LANGUAGES, LIBRARY, SAME, Plural

if TYPE_CHECKING:
    from collections.abc import Iterator

#: functions of the library that word a sentence: their first argument is what is translated
_WORDING = frozenset({"worded"})
_SAME_ON_PAPER = frozenset({report_words.FOOTER})


@dataclass(frozen=True)
class TextEntry:
    """A text to translate: where it stands, its English words, and those for one thing."""

    context: str
    words: str
    one: str = ""

    @property
    def id(self) -> str | tuple[str, str]:
        """Return what a catalogue calls it."""
        return (self.one, self.words) if self.one else self.words


def entries() -> list[TextEntry]:
    """Return every text of the app and every worded sentence of the library, in order."""
    names = [name for name in vars(texts) if name.isupper() and not name.startswith("_")]
    own = [one for name in names for one in _within(name, vars(texts)[name])]
    return [*own, *of_library()]


def _within(context: str, value: Any) -> Iterator[TextEntry]:  # noqa: ANN401 - a text, or many
    if context in SAME:
        return
    if isinstance(value, dict):
        for key, one in value.items():
            yield from _within(f"{context}.{key}", one)
    elif isinstance(value, tuple):
        for number, one in enumerate(value):
            yield from _within(f"{context}.{number}", one)
    elif isinstance(value, str):
        yield TextEntry(context, str(value), value.one if isinstance(value, Plural) else "")


def of_library() -> list[TextEntry]:
    """Return the sentences that the library words, as its source has them."""
    found = {entry.words: entry for entry in _of_reports()}
    for path in sorted(Path(fieldmon.__file__).parent.rglob("*.py")):
        if "_app" in path.parts:
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        named = _constants(tree)
        for node in ast.walk(tree):
            entry = None
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.args:
                entry = _worded(node.func.id, node.args, named)
            elif (many := _of_many(node)) is not None:
                entry = TextEntry(LIBRARY, many)
            if entry is not None:
                found.setdefault(entry.words, entry)
    return list(found.values())


def _of_reports() -> Iterator[TextEntry]:
    """Yield what reports write without wording it: headings, units, names."""
    titles = [kind.title for kind in of_equal_times().values()]
    named = (*IN_UNIT.values(), *titles, *RESULT_NAMES.values(), *shipped_words())
    for value in (*report_words.TEXTS.values(), *named):
        for entry in _within(LIBRARY, value):
            if entry.words not in _SAME_ON_PAPER and _has_letters(entry.words):
                yield TextEntry(LIBRARY, entry.words)


def _has_letters(words: str) -> bool:
    said = (literal for literal, *_ in Formatter().parse(words))
    return any(letter.isalpha() for one in said for letter in one)


def _of_many(node: ast.AST) -> str | None:
    """Return what is said of many features at once (see `ImportMessage.many`), if it is that."""
    named = (isinstance(node, ast.keyword) and node.arg == "many") or (
        isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and node.targets[0].id == "many"
    )
    value = getattr(node, "value", None) if named else None
    said = value.value if isinstance(value, ast.Constant) else None
    return said if isinstance(said, str) and said else None


def _constants(tree: ast.Module) -> dict[str, str]:
    """Return the texts that a module names."""
    return {
        one.targets[0].id: one.value.value
        for one in tree.body
        if isinstance(one, ast.Assign)
        and isinstance(one.targets[0], ast.Name)
        and isinstance(one.value, ast.Constant)
        and isinstance(one.value.value, str)
    }


def _worded(function: str, arguments: list[ast.expr], named: dict[str, str]) -> TextEntry | None:
    said = [
        named.get(one.id) if isinstance(one, ast.Name) else _value(one)
        for one in arguments
        if isinstance(one, ast.Constant | ast.Attribute | ast.Name)
    ]
    if function in _WORDING and said and isinstance(said[0], str) and _has_letters(said[0]):
        return TextEntry(LIBRARY, said[0])
    if function == "counted" and said and isinstance(said[-1], str):
        return TextEntry(LIBRARY, f"{{n:,}} {said[-1]}s", f"{{n:,}} {said[-1]}")
    return None


def _value(said: ast.Constant | ast.Attribute) -> object:
    """Return a text that stands in the source, or the one of the reports' words that it names."""
    if isinstance(said, ast.Constant):
        return said.value
    named = isinstance(said.value, ast.Name) and said.value.id == "words"
    return getattr(report_words, said.attr, None) if named else None


def path_of(language: str) -> Path:
    """Return a language's file."""
    return FOLDER / f"{language}.po"


def read(language: str) -> Catalog:
    """Return a language's texts."""
    with path_of(language).open("rb") as file:
        return read_po(file, locale=language)


def update(language: str) -> list[TextEntry]:
    """Write a language's file anew; return what is not translated."""
    before = read(language)
    after = Catalog(
        language, header_comment=before.header_comment, project="fieldmon",
        revision_date=before.revision_date, creation_date=before.creation_date,
        last_translator=before.last_translator, language_team=before.language_team,
        msgid_bugs_address=before.msgid_bugs_address, fuzzy=False,
    )  # fmt: skip
    missing = []
    for entry in entries():
        known = before.get(entry.id, entry.context)
        string = known.string if known else ""
        after.add(entry.id, string, context=entry.context)
        if not string or not all(string if isinstance(string, tuple) else (string,)):
            missing.append(entry)
    with path_of(language).open("wb") as file:
        write_po(file, after, width=100, omit_header=False)
    return missing


def main() -> None:
    """Bring all files up to date with the texts."""
    for language in LANGUAGES | DRAFTS:
        if language != ENGLISH:
            missing = update(language)
            print(f"{path_of(language).name}: {len(missing)} to translate")  # noqa: T201 - a command


if __name__ == "__main__":
    main()
