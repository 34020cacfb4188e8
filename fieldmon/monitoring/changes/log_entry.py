"""One entry of a season's log: what happened, by whom and when, and how it is said."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

from fieldmon.compute.wording import chance_figure, counted, estimate, filled, worded

#: what batches are numbered now, by their numbers of before; None: nobody knows
Numbers = dict[int, int | None]


@dataclass(frozen=True)
class LogEntry:
    """One entry of the log.

    Parameters
    ----------
    number
        From 1.
    at
        When it was written, UTC.
    kind
        ``"begins"``, ``"seen"``, ``"noted"``, ``"planned"``, ``"advised"``, ``"treated"``,
        ``"undone"``, ``"corrected"``, ``"changed"``, ``"labels"``, ``"merged"`` or ``"saved"``.
    who
        Whose doing; empty: nobody said.
    what
        What happened, by name.
    digest
        Of it and of all before it.
    numbers
        What batches that it names are numbered now, where a merge numbered them anew; None: nobody
        knows, as an earlier version merged.
    theirs
        Of a merge, the entries of the other copy that were not known here, as they stand there:
        numbers of entries and of batches are the copy's.
    of_copy
        Whether it is such an entry of the other copy.
    """

    number: int
    at: str
    kind: str
    who: str
    what: dict[str, Any]
    digest: str
    numbers: Numbers = field(default_factory=dict)
    theirs: tuple[LogEntry, ...] = ()
    of_copy: bool = field(default=False, compare=False)

    def sentence(self, most: int | None = None) -> str:
        """Return what happened, in words; of corrections so many at `most`, None: each."""
        what = _Blank(self.what)
        kind = "changed back" if self.kind == "changed" and what.get("back") else self.kind
        kind = "corrected here" if kind == "corrected" and what.get("here") else kind
        if isinstance(number := what.get("expected"), int | float):
            what["expected"] = estimate(number)
        if self.kind == "changed":  # earlier versions wrote the names of the parts alone
            what.setdefault("said", self.what.get("names", "?"))
        if self.kind == "corrected" and (said := what.get("said")):
            more = [] if most is None or len(said) <= most else ["..."]
            what["rows"] = "; ".join([*said[:most], *more])
        anew = "; batches were numbered anew" if what.get("moved") else ""
        undone = f"; undone there: {', '.join(gone)}" if (gone := what.get("undone")) else ""
        chosen = f"; taken over: {'; '.join(over)}" if (over := what.get("chosen")) else ""
        twice = "".join(f"; {one.removesuffix('.')}" for one in what.get("corrected", ()))
        told = _SAID[kind]
        if not what.get("source", "?"):  # recorded by a program that named no file
            told = told.removeprefix("{source}: ")
        what["came"] = f", {counted(n, 'treatment')}" if (n := what.get("treatments")) else ""
        back = ""
        if n := what.get("taken_back"):
            back = f"; {counted(n, 'inspection')} {'was' if n == 1 else 'were'} taken back there"
        said = filled(told, what) + back + chosen + undone + twice + anew
        for old, now in self.numbers.items():
            said += f"; batch {old} {f'is batch {now}' if now else 'has another number'} now"
        if self.kind in ("seen", "merged") and (added := what.get("more")):
            said += f"; {added}"
        if detects := what.get("detects"):
            said += f"; told to find {', '.join(map(_percent, detects))} of what is there"
        said += f"; lost: {'; '.join(self.lost)}" if self.lost else ""
        if self.of_copy and self.batch is not None:  # here that number is another batch's
            whose = worded("The number of the batch is the copy's.")
            said = f"{said.removesuffix('.')}. {whose}"
        return said

    @property
    def lost(self) -> tuple[str, ...]:
        """What was lost when the file was saved from a damaged one, in words."""
        return tuple(map(lost_in_words, self.what.get("lost", ())))

    @property
    def batch(self) -> int | None:
        """The batch of which its sentence tells, by the number that it had; None: of none."""
        told = self.what.get("said", "") if self.kind == "undone" else ""
        if (said := re.match(r"Batch (\d+) was ", told)) is not None:
            return int(said[1])
        number: int | None = self.what.get("batch")
        return number

    def __str__(self) -> str:
        """Return which entry it is, for a sentence about it."""
        return f"entry {self.number} ({self.at[:16]} UTC, {self.kind})"


def lost_in_words(gone: dict[str, Any]) -> str:
    """Return in words what the log notes as lost: rows of a batch, or of a layer."""
    if "layer" in gone:
        return worded("rows of the layer {layer}", layer=gone["layer"])
    return worded(
        "{missing:,} of {of:,} {of:row|rows} of batch {batch} ({source})",
        missing=gone["missing"], of=gone["of"], batch=gone["batch"], source=gone["source"] or "-",
    )  # fmt: skip


def _percent(chance: float) -> str:
    return str(chance_figure(chance))


class _Blank(dict[str, Any]):
    def __missing__(self, key: str) -> str:
        return "?"


_SAID = {
    "begins": "the log begins: {why}",
    "seen": "{source}: {found} found, {clean} clean, {skipped} could not be inspected, "
    "batch {batch}",
    "noted": "{source}: {more} to what was known, batch {batch}",
    "planned": "{date}: {stops} {stops:stop|stops} by {sampler}, "
    "about {expected} of them visibly infested",
    "advised": "{date}: {said}",
    "treated": "{date}: {said}, batch {batch}",
    "undone": "{said}",
    "corrected": "changes of another program taken as corrections: {rows}",
    "corrected here": "corrected: {rows}",
    "changed": "settings: {said}",
    "changed back": "settings, the last change taken back: {said}",
    "labels": "{labels} {labels:label|labels} from {source}",
    "merged": "another copy of the season taken in: {new} {new:inspection|inspections}{came}, "
    "{entries} {entries:entry|entries}",
    "saved": "saved from a damaged file",
}
