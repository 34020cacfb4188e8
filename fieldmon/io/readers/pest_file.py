"""Pests out of TOML files: each figure with its unit in its name, each part with its source."""

from __future__ import annotations

import re
import tomllib
from dataclasses import MISSING, fields
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, cast

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.options import Upload, source_name
from fieldmon.io.packaged import PESTS, packaged_text, pest_names
from fieldmon.pests.pest import Citation, Entry, Increase, Movement, Pest, Stage
from fieldmon.plot.robot import Viewpoints

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fieldmon.io.options import Source

_WORDS = ("name", "title", "species", "cutoff", "count_means", "not_found")
_COURSE = ("latency_days", "hidden_days", "mortality_per_day")
_DETECTION = ("viewpoints", "longer", "chance")
_TABLES: dict[str, tuple[str, ...]] = {
    "stages": tuple(each.name for each in fields(Stage)),
    "generation": ("threshold_c", "degree_days", "upper_c"),
    "increase": tuple(each.name for each in fields(Increase)),
    "movement": tuple(each.name for each in fields(Movement)),
    "entry": tuple(each.name for each in fields(Entry)),
    "detection": _DETECTION,
    "course": _COURSE,
}
_NOTES = ("sources", "doubts")
#: units by the ends of names
_UNITS = {
    "_per_day": "a day", "_days": "days", "_c": "degrees Celsius", "_m": "metres",
    "_mm": "millimetres",
}  # fmt: skip
_TEXTS = frozenset({"name", "kernel", "wind", *_WORDS})
_FLAGS = frozenset({"visible", "mobile", "by_hour"})
_LISTS = frozenset({"at_c", "per_day", "hours", "viewpoints"})
_HOTTEST_C = 45.0


def pest_of(said: str) -> Pest:
    """Return the pest of a name that comes with fieldmon, or of a file.

    Raises
    ------
    FileProblem
        If it is neither, or the file is no pest: the sentence says which line.

    Examples
    --------
    >>> pest_of("spider-mite").generation.degree_days
    146.48
    """
    if said in pest_names():
        return shipped_pest(said)
    path = Path(said)
    if not path.is_file():
        raise FileProblem(
            worded(
                "A pest must be a file, or one of {names}; but it is {said!r}.",
                names=", ".join(pest_names()),
                said=said,
            )
        )
    return read_pest(path)


@cache
def shipped_pest(name: str) -> Pest:
    """Return a pest that comes with fieldmon."""
    return pest_from_text(packaged_text(f"{PESTS}/{name}.toml"), f"{name}.toml")


@cache
def shipped_words() -> tuple[str, ...]:
    """Return what those pests and their stages are called, each once: all is translated."""
    pests = [shipped_pest(name) for name in pest_names()]
    stages = [stage.name for pest in pests for stage in pest.stages]
    return tuple(dict.fromkeys([*(pest.title for pest in pests), *stages]))


def read_pest(source: Source) -> Pest:
    """Return the pest of a TOML file; raise `FileProblem` with the line where it is none."""
    name = source_name(source)
    if isinstance(source, tuple):
        raise FileProblem(
            worded("A pest must be one file, but there are {n}: {name}.", n=len(source), name=name)
        )
    try:
        data = source.data if isinstance(source, Upload) else Path(source).read_bytes()
        text = data.decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise FileProblem(
            worded(
                "{name}: a pest must be text in UTF-8, but it cannot be read ({error}).",
                name=name,
                error=error,
            )
        ) from error
    return pest_from_text(text, name)


def pest_from_text(text: str, name: str) -> Pest:
    """Return the pest that the text of a TOML file says.

    Parameters
    ----------
    text
        What the file holds.
    name
        The file's name, for sentences.
    """
    try:
        told = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FileProblem(
            worded("{name}: a pest must be TOML, but it is not: {error}.", name=name, error=error)
        ) from error
    return _PestText(name, told, _lines_of(text)).pest()


class _At(NamedTuple):
    """Where a value stands: its table, which of several, its key."""

    table: str
    number: int
    key: str

    def having(self, value: object) -> dict[str, object]:
        """Return what a sentence of a value names."""
        return {"key": self.key, "value": value}


_HEADER = re.compile(r"^\s*(\[{1,2})\s*([\w.-]+)\s*\]{1,2}")
_KEY = re.compile(r"^\s*([\w-]+)\s*=")


def _lines_of(text: str) -> dict[_At, int]:
    """Return the line of each key, and of each table as the key ``""``."""
    found: dict[_At, int] = {}
    count: dict[str, int] = {}
    table, inside = "", False
    for number, line in enumerate(text.splitlines(), 1):
        quotes = line.count('"""') + line.count("'''")
        if not inside and (header := _HEADER.match(line)):
            table = header[2]
            count[table] = count.get(table, -1) + 1
            found[_At(table, count[table], "")] = number
        elif not inside and (key := _KEY.match(line)):
            found.setdefault(_At(table, count.get(table, 0), key[1]), number)
        inside ^= quotes % 2 == 1
    return found


class _PestText:
    """A pest as its file tells it, and where each value stands."""

    def __init__(self, name: str, told: dict[str, Any], lines: dict[_At, int]) -> None:
        self.name, self.told, self.lines = name, told, lines

    def pest(self) -> Pest:
        """Return the pest, or refuse with the line."""
        self._must_know()
        given = {key: self.told[key] for key in _WORDS if key in self.told}
        if "name" not in given:
            self._refuse(_At("", 0, ""), 'a pest must have a name, as name = "spider-mite".')
        for key, value in given.items():
            self._must_be_text(_At("", 0, key), value)
        given |= self._parts() | {"citations": tuple(self._citations())}
        course = self._table("course")
        given |= course
        return cast("Pest", self._made(Pest, given, _At("course", 0, "")))

    def _parts(self) -> dict[str, Any]:
        parts: dict[str, Any] = {
            "stages": tuple(
                self._made(Stage, self._checked("stages", stage, at), _At("stages", at, ""))
                for at, stage in enumerate(self._stages())
            )
        }
        if "generation" in self.told:
            whole = {"name": "generation", **self._table("generation")}
            parts["generation"] = self._made(Stage, whole, _At("generation", 0, ""))
        for part, kind in (("increase", Increase), ("movement", Movement), ("entry", Entry)):
            if part in self.told:
                parts[part] = self._made(kind, self._table(part), _At(part, 0, ""))
        return parts | self._seen()

    def _stages(self) -> list[dict[str, Any]]:
        stages = self.told.get("stages", [])
        if not isinstance(stages, list) or not all(isinstance(one, dict) for one in stages):
            self._refuse(
                _At("stages", 0, ""), "each stage must begin with [[stages]], in double brackets."
            )
        return stages

    def _seen(self) -> dict[str, Any]:
        """Return how it is detected."""
        told = self._table("detection")
        made: dict[str, Any] = {}
        if "viewpoints" in told:
            pairs = told["viewpoints"]
            if not all(isinstance(one, tuple) and len(one) == 2 for one in pairs):
                at = _At("detection", 0, "viewpoints")
                self._refuse(at, worded("viewpoints must be pairs, as [[20, 0.5], [40, 0.84]]."))
            longer = told.get("longer", pairs[-1][1] if pairs else 0.0)
            steps = {"steps": pairs, "longer": longer}
            made["viewpoints"] = self._made(Viewpoints, steps, _At("detection", 0, "viewpoints"))
        if "chance" in told:
            made["detection"] = told["chance"]
        return made

    def _table(self, part: str) -> dict[str, Any]:
        table = self.told.get(part, {})
        self._must_be_table(part, table)
        return self._checked(part, table, 0)

    def _checked(self, part: str, table: dict[str, Any], number: int) -> dict[str, Any]:
        """Return a table whose keys are known and whose values are of their kind."""
        for key in table:
            if key not in _TABLES[part]:
                self._refuse(_At(part, number, key), _unknown(key, _TABLES[part], f"[{part}]"))
        return {key: self._value(_At(part, number, key), value) for key, value in table.items()}

    def _value(self, at: _At, value: object) -> Any:  # noqa: ANN401 - text, flag, number or list
        if at.key in _TEXTS:
            self._must_be_text(at, value)
            return value
        said = at.having(value)
        if at.key in _FLAGS:
            rule = worded("{key} must be true or false, but it is {value!r}.", **said)
            self._must(isinstance(value, bool), at, rule)
            return value
        is_list = at.key in _LISTS and (at.table, at.key) not in {
            ("movement", "at_c"),
            ("movement", "per_day"),
        }
        if is_list:
            if not isinstance(value, list):
                rule = worded("{key} must be a list in brackets, but it is {value!r}.", **said)
                self._refuse(at, rule)
            return tuple(
                tuple(self._number(at, inner) for inner in one)
                if isinstance(one, list)
                else self._number(at, one)
                for one in value
            )
        return self._number(at, value)

    def _number(self, at: _At, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            unit = next((said for end, said in _UNITS.items() if at.key.endswith(end)), "")
            kind = (
                worded("a number in {unit}", unit=unit)
                if unit and unit != "a day"
                else worded("a number")
            )
            self._refuse(
                at,
                worded(
                    "{key} must be {kind}, without quotes, but it is {value!r}.",
                    kind=kind,
                    **at.having(value),
                ),
            )
        return float(value)

    def _must_be_text(self, at: _At, value: object) -> None:
        rule = worded("{key} must be text in quotes, but it is {value!r}.", **at.having(value))
        self._must(isinstance(value, str), at, rule)

    def _must_be_table(self, part: str, value: object) -> None:
        rule = worded("{part} must be a table, as [{part}].", part=part)
        self._must(isinstance(value, dict), _At(part, 0, ""), rule)

    def _must_know(self) -> None:
        known = (*_WORDS, *_TABLES, *_NOTES)
        for key in self.told:
            if key not in known:
                at = _At("", 0, key)
                at = at if at in self.lines else _At(key, 0, "")
                self._refuse(at, _unknown(key, known, worded("a pest")))

    def _citations(self) -> Iterable[Citation]:
        notes = {}
        for note in _NOTES:
            notes[note] = self.told.get(note, {})
            self._must_be_table(note, notes[note])
            for part, words in notes[note].items():
                at = _At(note, 0, part)
                if part not in self.told or part not in _TABLES:
                    self._refuse(
                        at,
                        worded(
                            "[{note}] speaks of {part}, which is no part of this pest.",
                            note=note,
                            part=part,
                        ),
                    )
                self._must_be_text(at, words)
        for part in _TABLES:
            if part not in self.told:
                continue
            if not notes["sources"].get(part, "").strip():
                self._refuse(
                    _At(part, 0, ""),
                    worded(
                        "[{part}] has no source. Say under [sources] who published it, or that it "
                        'is your choice: {part} = "...".',
                        part=part,
                    ),
                )
            yield Citation(part, notes["sources"][part], notes["doubts"].get(part, ""))

    def _made(self, kind: Any, given: dict[str, Any], at: _At) -> Any:  # noqa: ANN401 - a dataclass
        """Return a value of a kind; what it refuses is refused with the line of the key named."""
        for each in fields(kind):
            needed = each.default is MISSING and each.default_factory is MISSING
            if needed and each.name not in given:
                self._refuse(
                    at,
                    worded(
                        "[{table}] must say its {name}, but does not.",
                        table=at.table,
                        name=each.name,
                    ),
                )
        try:
            return kind(**given)
        except SettingError as error:
            sentence = error.args[0]
            named = [key for key in given if re.search(rf"\b{re.escape(key)}\b", sentence)]
            key = named[0] if named else ""
            value = given.get(key)
            hot = isinstance(value, float) and key.endswith("_c") and value > _HOTTEST_C
            if hot:
                sentence = joined(" ", (sentence, worded("Is it in Fahrenheit?")))
            closer = at._replace(key=at.key or key)
            if kind is Pest and key in _TABLES:  # parts that do not go together
                inner = [one for one in re.findall(r"\w+", sentence) if one in _TABLES[key]]
                closer = _At(key, 0, inner[0] if inner else "")
            where = closer if closer in self.lines else at
            self._refuse(where, sentence, error)

    def _must(self, holds: bool, at: _At, rule: str) -> None:  # noqa: FBT001 - what must hold
        if not holds:
            self._refuse(at, rule)

    def _refuse(self, at: _At, sentence: str, cause: Exception | None = None) -> NoReturn:
        line = self.lines.get(at) or self.lines.get(at._replace(key="")) or 1
        raise FileProblem(
            worded(
                "{file}, {line}: {problem}",
                file=self.name,
                line=worded("line {n}", n=line),
                problem=sentence,
            )
        ) from cause


def _unknown(key: str, known: Iterable[str], of: str) -> str:
    """Return why a key is refused: another unit, a slip of the pen, or nothing that is known."""
    stem = key.rsplit("_", 1)[0]
    other_unit = [name for name in known if "_" in name and name.rsplit("_", 1)[0] == stem]
    if other_unit:
        name = other_unit[0]
        unit = next((said for end, said in _UNITS.items() if name.endswith(end)), "")
        return worded(
            "{key} has another unit than fieldmon reads: convert it to {unit}, as {name}.",
            key=key,
            unit=unit,
            name=name,
        )
    near = get_close_matches(key, [*known], 1)
    hint = (
        worded(
            " Is it {near}?",
            near=near[0],
        )
        if near
        else ""
    )
    return worded(
        "{key} is nothing that {of} can say ({names}).{hint}",
        key=key,
        of=of,
        names=", ".join(known),
        hint=hint,
    )
