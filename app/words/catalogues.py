"""What there is to translate, and the files that hold it: ``python -m app.words.catalogues``.

The command writes each language's file anew: new texts with no translation yet, gone ones left
out, all others as they were and where they were. A text whose English changed keeps the translation
of before, marked as gettext does: ``#, fuzzy``, and behind ``#|`` what it was in English. Users are
shown English until somebody corrects it and takes these lines out. A translator needs nothing but
that file.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from difflib import get_close_matches
from io import BytesIO
from pathlib import Path
from string import Formatter
from typing import TYPE_CHECKING, Any

from babel.messages.catalog import Catalog
from babel.messages.pofile import normalize, read_po, write_po

import fieldmon
from fieldmon.compute.units import IN_UNIT
from fieldmon.infestation.inspections import RESULT_NAMES
from fieldmon.io.readers.pest_file import shipped_words
from fieldmon.reports import words as report_words
from fieldmon.samplers import of_equal_times

from . import texts
from .language import DRAFTS, ENGLISH, LANGUAGES, LIBRARY, SAME, Plural
from .translations import FOLDER

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from babel.messages.catalog import Message

    #: a text's context, and its words
    Key = tuple[str, str]

#: functions of the library that word a sentence: their first argument is what is translated
_WORDING = frozenset({"worded"})
# what stands in a module that has anything to translate
_MAY_SAY = re.compile(r"\bworded\(|\bcounted\(|\bmany\s*=")
_WIDTH = 100
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

    @property
    def key(self) -> Key:
        """Return where it stands and its words: no other text has both."""
        return self.context, self.words


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
        source = path.read_text(encoding="utf-8")
        if not _MAY_SAY.search(source):  # to look takes a hundredth of what reading it as code does
            continue
        tree = ast.parse(source)
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
    wanted = {entry.key: entry for entry in entries()}
    known = {_key(message): message for message in before if message.id}
    gone = {key: message for key, message in known.items() if key not in wanted}
    missing, of_before = [], list[list[str]]()
    found = {key: known.get(key) or _before(entry, gone) for key, entry in wanted.items()}
    places = {key: _key(message) for key, message in found.items() if message}
    for key in _in_place(wanted, known, places):
        entry, message = wanted[key], found[key]
        string = message.string if message else ""
        doubtful = message is not None and (message.fuzzy or places[key] != key)
        flags = ["fuzzy"] if doubtful else []
        after.add(entry.id, string, context=entry.context, flags=flags)
        if message is not None and doubtful:
            of_before.append(_said_before(message))
        if doubtful or not string or not all(string if isinstance(string, tuple) else (string,)):
            missing.append(entry)
    written = BytesIO()
    write_po(written, after, width=_WIDTH, omit_header=False)
    path_of(language).write_bytes(_with_before(written.getvalue(), of_before))
    return missing


def _key(message: Message) -> Key:
    return message.context or "", message.id if isinstance(message.id, str) else message.id[1]


def _before(entry: TextEntry, gone: dict[Key, Message]) -> Message | None:
    """Return what a text was whose English changed: of those gone, by its place or its words."""
    alike = {
        key: message
        for key, message in gone.items()
        if key[0] == entry.context and isinstance(message.id, str) != bool(entry.one)
    }
    words = [words for _, words in alike]
    if entry.context == LIBRARY:
        words = get_close_matches(entry.words, words, 1)
    return alike[entry.context, words[0]] if words else None


def _in_place(wanted: Iterable[Key], known: Iterable[Key], places: dict[Key, Key]) -> list[Key]:
    """Return texts in the order of a file: what is new comes behind what it stands behind now."""
    at = {key: number for number, key in enumerate(known)}
    order: dict[Key, tuple[int, int]] = {}
    last = (-1, 0)
    for number, key in enumerate(wanted):
        last = (at[places[key]], 0) if key in places else (last[0], number + 1)
        order[key] = last
    return sorted(order, key=order.__getitem__)


def _said_before(message: Message) -> list[str]:
    """Return the lines of a file that say in English what was translated."""
    if message.fuzzy:  # they are there already
        return [f"#{line}" for line in message.user_comments if line.startswith("|")]
    ids = (message.id,) if isinstance(message.id, str) else message.id
    names = ("msgid", "msgid_plural")
    said = (f"{name} {normalize(id_, width=_WIDTH)}" for name, id_ in zip(names, ids, strict=False))
    return [f"#| {line}" for one in said for line in one.splitlines()]


def _with_before(data: bytes, of_before: list[list[str]]) -> bytes:
    """Return a file with what was translated behind each mark: babel breaks it where it is long."""
    lines, left = list[str](), iter(of_before)
    for line in data.decode().split("\n"):
        lines += [line, *(next(left) if line.startswith("#, fuzzy") else ())]
    return "\n".join(lines).encode()


def main() -> None:
    """Bring all files up to date with the texts."""
    for language in LANGUAGES | DRAFTS:
        if language != ENGLISH:
            missing = update(language)
            print(f"{path_of(language).name}: {len(missing)} to translate")  # noqa: T201 - a command


if __name__ == "__main__":
    main()
