"""Action thresholds: from which infestation on treating pays, and who says so."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from fieldmon.compute.wording import joined, worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.io.options import Upload, source_name
from fieldmon.io.packaged import packaged_table, pest_names
from fieldmon.io.parse.own_table import own_table
from fieldmon.io.parse.values import decimal_mark, number, told_number

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

#: what a threshold counts; a share lies between 0 and 1, a mean is animals a leaf
MEASURES = ("share of plants", "share of leaves", "mean per leaf")
_OWN = "your own"
_COLUMNS = ("name", "measure", "level", "source")


@dataclass(frozen=True)
class Threshold:
    """From which infestation on treating pays.

    Parameters
    ----------
    name
        By which it is asked for.
    measure
        What is counted: ``"share of plants"`` or ``"share of leaves"`` that are infested, or
        ``"mean per leaf"``, the animals on one.
    level
        Treat from this on: a share between 0 and 1, or a mean above 0.
    source
        Who says so.
    crop, when
        Where it holds, in words; empty: not said.
    pest
        For which pest; of fieldmon's pests by their names, as ``"spider-mite; thesis"``. Empty:
        not said.

    Raises
    ------
    SettingError
        If the measure is not known, or the level is not one of it.
    """

    name: str
    measure: str
    level: float
    source: str = _OWN
    crop: str = ""
    pest: str = ""
    when: str = ""

    def __post_init__(self) -> None:
        if self.measure not in MEASURES:
            raise SettingError(
                worded(
                    "An action threshold must count one of {names}, but {name!r} counts "
                    "{measure!r}.",
                    names=", ".join(MEASURES),
                    name=self.name,
                    measure=self.measure,
                )
            )
        most = float("inf") if self.measure == "mean per leaf" else 1.0
        if not 0.0 < self.level < most:
            raise SettingError(
                worded(
                    "The action threshold {name!r} must be above 0{below}, but it is {level:g}.",
                    name=self.name,
                    below=worded(" and below 1 (100 %)") if most == 1.0 else "",
                    level=self.level,
                )
            )

    @property
    def is_share(self) -> bool:
        """Return whether it is a share, so that presence is all that need be seen."""
        return self.measure != "mean per leaf"

    @property
    def pests(self) -> tuple[str, ...]:
        """Return the pests that it is for, each by its name."""
        return tuple(filter(None, map(str.strip, self.pest.split(";"))))

    def is_for_another(self, pest: str) -> bool:
        """Tell whether it is for other pests of fieldmon's than the one of this name."""
        known = pest_names()
        return bool(pest and self.pests) and all(one in known and one != pest for one in self.pests)

    def doubt(self, pest: str) -> str:
        """Return in a sentence that it is for another pest than `pest`; empty: it is not."""
        if not self.is_for_another(pest):
            return ""
        return worded(
            "The action threshold {name!r} is for {pests}, but the season's pest is {pest}: take "
            "one for it, or a share of the plants.",
            name=self.name,
            pests=", ".join(self.pests),
            pest=pest,
        )

    def sentence(self) -> str:
        """Return it in words, with its source."""
        if not self.is_share:
            level = worded("{level:g} a leaf", level=self.level)
        elif self.measure == "share of plants":
            level = worded("{level:g} % of the plants infested", level=100 * self.level)
        else:
            level = worded("{level:g} % of the leaves infested", level=100 * self.level)
        return worded(
            "Treat from {level} on ({source}).",
            level=level,
            source=self.source,
        )


@lru_cache(maxsize=1)
def published() -> tuple[Threshold, ...]:
    """Return the thresholds that come with fieldmon, each with its source."""
    return tuple(map(_of_row, packaged_table("fieldmon/decisions/thresholds.csv")))


def in_order_for(pest: str, known: Iterable[Threshold]) -> tuple[Threshold, ...]:
    """Return thresholds with those first that are for the pest of this name, or for any.

    Examples
    --------
    >>> mine = Threshold("mine", "share of plants", 0.05, pest="whitefly")
    >>> in_order_for("whitefly", (*published(), mine))[0].name
    'mine'
    """
    return tuple(sorted(known, key=lambda one: one.is_for_another(pest)))


def read_thresholds(source: Path | Upload) -> tuple[Threshold, ...]:
    """Return thresholds of one's own from a CSV with the columns of the published ones.

    Raises
    ------
    FileProblem
        If the file cannot be read, or a line is no threshold: the sentence says which.
    """
    name = source_name(source)
    try:
        data = source.data if isinstance(source, Upload) else source.read_bytes()
        text = data.decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise FileProblem(
            worded(
                "{name}: thresholds must be text in UTF-8 ({error}).",
                name=name,
                error=error,
            )
        ) from error
    table = own_table(text, name)
    missing = [name for name in _COLUMNS if name not in table.columns]
    if missing:
        raise FileProblem(
            worded(
                "{name}: thresholds need the columns {names}, but there is no {names_2}.",
                name=name,
                names=", ".join(_COLUMNS),
                names_2=" and no ".join(missing),
            )
        )
    read = tuple(_read(where, cells) for where, cells in table.lines)
    if not read:
        raise FileProblem(
            worded("{name} must hold a threshold or more, but it holds none.", name=name)
        )
    called = Counter(one.name for one in read).most_common(1)[0]
    if called[1] > 1:
        raise FileProblem(
            worded(
                "{name}: two thresholds are called {called!r}. Give each its own name.",
                name=name,
                called=called[0],
            )
        )
    return read


def threshold_of(said: str, known: Iterable[Threshold] | None = None) -> Threshold:
    """Return the threshold of a name, or of a share of plants as ``"5%"``.

    Parameters
    ----------
    said
        ``"almond"``, or a share of the plants: ``"5%"``, ``"5 %"``.
    known
        Where names are looked up; None: the published ones.

    Raises
    ------
    SettingError
        If it is neither.

    Examples
    --------
    >>> threshold_of("almond").level
    0.22
    >>> threshold_of("2.5%").sentence()
    'Treat from 2.5 % of the plants infested on (your own).'
    """
    options = {one.name: one for one in (published() if known is None else known)}
    if said in options:
        return options[said]
    if said.endswith("%"):
        try:
            share = _percents(said)
        except SettingError:
            pass
        else:
            return Threshold(said, "share of plants", share)
    rule = worded(
        "An action threshold must be a share of the plants, as 5%, or one of {names}; but "
        "it is {said!r}.",
        names=", ".join(options),
        said=said,
    )
    raise SettingError(joined(" ", (rule, *_meant(said))))


def _meant(said: str) -> list[str]:
    """Return in a question which share a number alone may mean; nothing where it is none."""
    value = number(said, decimal_mark([said]) or ".")
    if not 0.0 < value < 100.0:
        return []
    return [worded("Did you mean {percents:g}%?", percents=value if value >= 1.0 else 100 * value)]


def _read(where: str, row: Mapping[str, str]) -> Threshold:
    try:
        return _of_row(row)
    except SettingError as error:
        raise FileProblem(
            worded("{where}: {problem}", where=where, problem=error.args[0])
        ) from error


def _level(text: str, measure: str) -> float:
    """Return a level; that of a share also as percents."""
    if text.endswith("%") and measure.startswith("share"):
        return _percents(text)
    return told_number(text, "level")


def _percents(text: str) -> float:
    """Return a share that is told in percents, as ``"5 %"``."""
    return told_number(text[:-1], "level", most=100.0) / 100


def _of_row(row: Mapping[str, str]) -> Threshold:
    words = {name: row.get(name) or "" for name in ("crop", "pest", "when")}
    return Threshold(
        row["name"],
        row["measure"],
        _level(row["level"], row["measure"]),
        row["source"] or _OWN,
        **words,
    )
