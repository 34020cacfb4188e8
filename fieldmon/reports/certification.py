"""The record of a season, or of several, for a certifier: what was applied, seen and advised.

Of each application it says what GLOBALG.A.P. asks (IFA, Crops Base 7.3): place, date and end, crop,
product, dose, water and area, reason, operator, who authorised it, machinery, waiting
period, active ingredient, weather.
What nobody said stands as not said: nothing is filled in.
"""

from __future__ import annotations

from collections import Counter
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.wording import KeptText, counted, figure, joined, worded
from fieldmon.errors import FieldmonError, SettingError
from fieldmon.infestation.inspections import FOUND
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.estimates.verifying import check_against_log
from fieldmon.monitoring.inspecting.known_inspections import corrected_by, seen_by_others
from fieldmon.monitoring.merging.other_seasons import by_plot, called_apart, of_one_plot
from fieldmon.monitoring.treating.cautions import groups, label_of, waits
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.named_rows import place_in_words
from fieldmon.reports import words
from fieldmon.reports.content import (
    Block,
    KeyFigure,
    KeyFigures,
    Listing,
    Paragraph,
    Report,
    Sheet,
    Table,
)
from fieldmon.reports.sentences import changed_later

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from datetime import date

    from fieldmon.compute.units import Units
    from fieldmon.infestation.inspections import Inspections
    from fieldmon.monitoring import Caution, KeptTreatment, LogEntry, Season
    from fieldmon.monitoring.estimates.treatment_effect import TreatmentEffect
    from fieldmon.monitoring.treating.applications import Application

# as many letters as a value beside its name may have, and a line of sentences; millimetres that
# lines, titles and a page take up, a little more than they do
_SHORT, _LINE_LETTERS = 30, 100
_ROW_MM, _LINE_MM, _TITLE_MM, _PAGE_MM = 4.1, 3.8, 9.0, 240.0
_DAYS_A_PAGE = 92


@dataclass(frozen=True, eq=False)
class _PlotRecord:
    """What one season holds up to a day."""

    season: Season
    called: str
    on: date
    units: Units
    treatments: tuple[KeptTreatment, ...]
    harvest_unsaid: date | None
    cautions: tuple[Caution, ...]
    effects: tuple[TreatmentEffect, ...]
    log: tuple[LogEntry, ...]
    wrong: str
    done: Inspections
    corrected: dict[str, set[str]]
    also: dict[str, Counter[str]]

    @classmethod
    def of(cls, season: Season, called: str, until: date | None, units: Units) -> _PlotRecord:
        on = default_date(season) if until is None else until
        done = tuple(one for one in season.treatments() if one.on <= on)
        # until when nobody may enter stands with each treatment: a record is read after it
        beware = tuple(one for one in season.cautions(on, units) if one.kind != "entry")
        told = season.effects(on, units)
        try:
            log, wrong = season.log(), " ".join(check_against_log(season))
        except FieldmonError as changed:
            log, wrong = (), str(changed)
        first = season.harvest_from(on)
        unsaid = None if first is None or first[0] is not None else first[1].on
        seen = season.inspections
        seen = seen.take(seen.date <= np.datetime64(on, "D")).inspected
        corrected: dict[str, set[str]] = {}
        for (_, day, *_), who in corrected_by(season).items():
            corrected.setdefault(str(day), set()).add(who)
        others = seen_by_others(season)
        return cls(
            season, called, on, units, done, unsaid, beware, told, log, wrong, seen,
            corrected, others,
        )  # fmt: skip

    @property
    def name(self) -> str:
        return words.isolated(self.called)

    @cached_property
    def all_told(self) -> list[LogEntry]:
        """The entries of the log and of copies that were merged, as they were written."""
        both = [one for entry in self.log for one in (*entry.theirs, entry)]
        # of one log they are in order, whatever clocks showed
        return sorted(both, key=lambda one: one.at) if len(both) > len(self.log) else both

    def harvest_from(self, first: date | None) -> str:
        """Return from when on harvest is allowed after a treatment; empty: nobody said.

        While nobody said how long another one waits, no day is named.
        """
        if first is None or self.harvest_unsaid is None:
            return "" if first is None else self.units.day(first)
        return worded(words.CERT_HARVEST_UNSAID, day=self.units.day(self.harvest_unsaid))

    def inspected(self) -> tuple[int, int]:
        """Return how many inspections there were, and finds among them."""
        return len(self.done), int(np.count_nonzero(self.done.result == FOUND))

    def advised(self, one: KeptTreatment) -> str:
        """Return what was advised last, up to a treatment's day; empty: nothing.

        What was advised before an earlier treatment was for that one, and what was advised after
        it on its day is for the next.
        """
        day, treated = str(one.on), False
        before = max((str(other.on) for other in self.treatments if other.on < one.on), default="")
        said: list[dict[str, Any]] = []
        for entry in self.all_told:
            on = entry.what.get("date", "")
            if entry.kind == "treated":
                treated |= on == day
                said = [what for what in said if on != before or what["date"] > before]
            if entry.kind == "advised" and before <= on <= day and not (treated and on == day):
                said.append(entry.what)
        if not said:
            return ""
        on = self.units.day(said[-1]["date"])
        return worded("{said} ({day})", said=KeptText(said[-1]["said"]), day=on)


def certification_report(
    seasons: Sequence[Season], units: Units, until: date | None = None
) -> Report:
    """Return the record of seasons up to a day; nothing is kept by it.

    None is the last day of each, today at most.

    Raises
    ------
    SettingError
        If no season is given, or the day lies before one begins.
    """
    if not seasons:
        raise SettingError(
            worded("A certification report must be of a season or more, but none is given.")
        )
    with ExitStack() as still:
        for season in seasons:
            still.enter_context(season.store.one_moment())
        called = called_apart(seasons)
        records = [
            _PlotRecord.of(season, name, until, units)
            for season, name in zip(seasons, called, strict=True)
        ]
        begins = min(one.season.settings.begins for one in records)
        on = max(one.on for one in records)
        title = worded(words.CERT_TITLE, begins=units.day(begins), day=units.day(on))
        sheets = [Sheet(words.CERT_SHEETS[0], page) for page in _pages(_summary(records))]
        sheets += [Sheet(words.CERT_SHEETS[1], page) for page in _pages(_applications(records))]
        tables = ((table,) for one in records for table in _inspections(one))
        sheets += [Sheet(words.CERT_SHEETS[2], page) for page in _pages(tables)]
    plots = [*dict.fromkeys(one.season.plot.field.name for one in records)]
    named = plots[0] if len(plots) == 1 else ", ".join(map(words.isolated, plots))
    return Report(named, title, on, tuple(sheets))


# -- pages


def _pages(blocks: Iterable[tuple[Block, ...]]) -> Iterator[tuple[Block, ...]]:
    """Yield blocks page by page; those handed over together stay together."""
    page: list[Block] = []
    used_mm = 0.0
    for together in blocks:
        high_mm = sum(map(_high_mm, together))
        if page and used_mm + high_mm > _PAGE_MM:
            yield tuple(page)
            page, used_mm = [], 0.0
        page += together
        used_mm += high_mm
    if page:
        yield tuple(page)


def _high_mm(block: Block) -> float:
    """Return the height that a block takes up on paper, a little more than it does."""
    if isinstance(block, Table):
        return _TITLE_MM + _ROW_MM * (-(-len(block.rows) // block.flow) + 1)
    if isinstance(block, Listing):
        return _TITLE_MM + sum(map(_lines_mm, block.sentences))
    if isinstance(block, Paragraph):
        return _lines_mm(block.text) * (1.6 if block.lead else 1.0) + 4.0
    return 19.0


def _lines_mm(text: str) -> float:
    return _LINE_MM * (len(text) // _LINE_LETTERS + 1) + 0.8


# -- the summary


def _summary(records: list[_PlotRecord]) -> Iterator[tuple[Block, ...]]:
    n = sum(len(one.treatments) for one in records)
    seen = [one.inspected() for one in records]
    area_ha = sum(t.place.area_ha or 0.0 for one in records for t in one.treatments)
    n_plots = len(by_plot(one.season for one in records))
    lead = worded(
        words.CERT_LEAD,
        treatments=counted(n, "treatment"), plots=counted(n_plots, "plot"),
        inspections=counted(sum(k for k, _ in seen), "inspection"),
        finds=counted(sum(k for _, k in seen), "find"),
    )  # fmt: skip
    units = records[0].units
    figures = KeyFigures(
        (
            KeyFigure(words.TREATMENTS, figure(n)),
            KeyFigure(words.CERT_AREA, units.square(area_ha * 1e4), words.CERT_AREA_NOTE),
            KeyFigure(words.CERT_INSPECTIONS, figure(sum(k for k, _ in seen))),
            KeyFigure(words.CERT_FINDS, figure(sum(k for _, k in seen))),
            KeyFigure(words.CERT_CAUTIONS, figure(len(_cautions(records)))),
        )
    )
    yield Paragraph(lead, lead=True), figures
    for table in _parts(_plots(records, seen), 40):
        yield (table,)
    yield from _listed(words.CERT_CAUTIONS, _cautions(records), words.CERT_CAUTIONS_NONE)
    yield from _listed(words.CERT_UNSAID, _unsaid(records), words.CERT_UNSAID_NONE)
    yield from _listed(words.CERT_LOG, [_log(one) for one in records], "")
    if changed := _changed_later(records):
        yield from _listed(words.CHANGED_LATER, changed, "")
    yield (Listing(words.MEANING, words.CERT_MEANINGS),)


def _listed(title: str, said: Sequence[str], none: str) -> Iterator[tuple[Block, ...]]:
    """Yield sentences as listings that can be parted between pages."""
    for first in range(0, max(len(said), 1), 12):
        part = tuple(said[first : first + 12]) or (none,)
        yield (Listing(title if not first else "", part),)


def _plots(records: list[_PlotRecord], seen: list[tuple[int, int]]) -> Table:
    rows = tuple(
        (
            one.name,
            one.units.square(_area_m2(one.season)),
            one.units.day(one.season.settings.begins),
            one.units.day(one.on),
            figure(len(one.treatments)),
            figure(inspected),
            figure(found),
        )
        for one, (inspected, found) in zip(records, seen, strict=True)
    )
    return Table(
        words.CERT_PLOTS, words.CERT_PLOT_COLUMNS, rows,
        (0.28, 0.14, 0.13, 0.13, 0.11, 0.11, 0.1), left=(0,), whole=True,
    )  # fmt: skip


def _area_m2(season: Season) -> float:
    return float(season.plot.grid.frame.geometry_m(season.plot.field.boundary).area)


def _parts(table: Table, most: int) -> Iterator[Table]:
    """Yield a table in parts of so many rows; the first has its title."""
    for first in range(0, len(table.rows), most):
        yield Table(
            table.title if not first else "", table.columns, table.rows[first : first + most],
            table.shares, table.flow, left=table.left, whole=True,
        )  # fmt: skip


def _cautions(records: list[_PlotRecord]) -> list[str]:
    """Return what to beware of; treatments of one day may have the same warning: it stands once.

    That several seasons are of one plot comes first: what was done there counts in each.
    """
    twice = of_one_plot((one.season for one in records), words.isolated)
    said = (_of_plot(one, beware.sentence, records) for one in records for beware in one.cautions)
    return [*twice, *dict.fromkeys(said)]


def _of_plot(one: _PlotRecord, said: str, records: list[_PlotRecord]) -> str:
    """Return a sentence with its plot before it, where there are several."""
    return worded(words.CERT_ON_PLOT, plot=one.name, said=said) if len(records) > 1 else said


def _unsaid(records: list[_PlotRecord]) -> list[str]:
    """Return what GLOBALG.A.P. asks of each treatment, and of inspections, and nobody said."""
    said: list[str] = []
    for one in records:
        lost = [what for entry in one.all_told for what in entry.lost]
        said += [worded(words.CERT_ON_PLOT, plot=one.name, said=what) for what in lost]
        for treatment in one.treatments:
            missing = [
                label
                for label, value in _fields(one, treatment)
                if not value and label in _ASKED_FOR
            ]
            if missing:
                said.append(
                    worded(
                        words.CERT_MISSING, plot=one.name, day=one.units.day(treatment.on),
                        what=joined(", ", missing),
                    )
                )  # fmt: skip
        if unnamed := int(np.count_nonzero(one.done.who == "")):
            by_whom = worded(words.CERT_BY_WHOM, n=unnamed, of=len(one.done))
            said.append(worded(words.CERT_ON_PLOT, plot=one.name, said=by_whom))
    return said


def _log(one: _PlotRecord) -> str:
    """Return whether the past is what was written, and the digest to keep."""
    if one.wrong:
        return worded(words.CERT_ON_PLOT, plot=one.name, said=one.wrong)
    return worded(
        words.CERT_LOG_HOLDS, plot=one.name, n=len(one.log),
        since=one.units.day(one.log[0].at[:10]), digest=one.log[-1].digest,
    )  # fmt: skip


def _changed_later(records: list[_PlotRecord]) -> list[str]:
    """Return what was taken back and corrected, by whom and when, here or in a copy."""
    return [
        _of_plot(one, said, records)
        for one in records
        for said in changed_later(one.log, local_clock(one.season.plot.field), one.units)
    ]


# -- the applications


_F = words.CERT_FIELDS
_ASKED_FOR = tuple(
    _F[name]
    for name in (
        *("product", "ingredient", "dose", "reason", "operator", "waiting", "machinery", "weather"),
        *("crop", "authorised"),
    )
)


def _applications(records: list[_PlotRecord]) -> Iterator[tuple[Block, ...]]:
    number = 0
    for one in records:
        for treatment in one.treatments:
            number += 1
            yield _card(number, one, treatment)
    if not number:
        yield (Paragraph(words.TREATMENTS_NONE),)


def _card(number: int, one: _PlotRecord, treatment: KeptTreatment) -> tuple[Block, ...]:
    """Return all there is to say of one treatment: short values in a table, long ones below."""
    said = [(label, value or words.CERT_NOT_SAID) for label, value in _fields(one, treatment)]
    short = tuple((label, value) for label, value in said if len(value) <= _SHORT)
    long = [
        worded("{what}: {said}", what=label, said=value)
        for label, value in said
        if len(value) > _SHORT
    ]
    more = [caution.sentence for caution in one.cautions if caution.batch == treatment.batch]
    more += [effect.sentence() for effect in one.effects if effect.batch == treatment.batch]
    title = worded(
        words.CERT_TITLE_OF, number=number, plot=one.name, day=one.units.day(treatment.on)
    )
    table = Table(title, words.CERT_COLUMNS, short, (0.4, 0.6), flow=2, left=(0, 1), whole=True)
    below = (*long, *more)
    return (table, Listing("", below)) if below else (table,)


def times_said(said: Application) -> str:
    """Return when it began and ended; one alone in words, for a sign has no side of its own."""
    began, ended = (f"{at:%H:%M}" if at else "" for at in (said.began, said.ended))
    if began and ended:
        return f"{began}–{ended}"
    if began:
        return worded(words.CERT_BEGAN, time=began)
    return worded(words.CERT_ENDED, time=ended) if ended else ""


def _fields(one: _PlotRecord, treatment: KeptTreatment) -> list[tuple[str, str]]:
    """Return what a certifier asks of a treatment, with its name; empty: not said."""
    said, place = treatment.application, treatment.place
    label = label_of(treatment, one.season.labels())
    period = waits(treatment, label)
    first, entry = period.harvest_from, period.entry_from
    days = "" if period.days is None else counted(period.days, "day")
    return [
        (_F["product"], _plain(said.product)),
        (_F["ingredient"], _plain(said.active_ingredient)),
        (_F["group"], "+".join(groups(treatment, label))),
        (_F["dose"], "" if said.dose is None else str(said.dose)),
        (_F["water"], "" if said.water_l_ha is None else worded(words.RATE, rate=said.water_l_ha)),
        (_F["area"], "" if place.area_ha is None else one.units.square(place.area_ha * 1e4)),
        (_F["plants"], figure(int(np.count_nonzero(one.season.plot.grid.vines_of(place.plants))))),
        (_F["where"], place_in_words(one.season.plot.grid, place.plants)),
        (_F["time"], times_said(said)),
        (_F["zone"], treatment.clock.zone),
        (_F["crop"], _plain(said.crop)),
        (_F["pest"], _plain(said.pest)),
        (_F["operator"], _plain(said.operator)),
        (_F["authorised"], _plain(said.authorised_by)),
        (_F["machinery"], _plain(said.machinery)),
        (_F["weather"], _plain(said.weather)),
        (_F["waiting"], days),
        (_F["harvest"], one.harvest_from(first)),
        (
            _F["entry"],
            ""
            if entry is None
            else worded("{day} {time}", day=one.units.day(entry.date()), time=f"{entry:%H:%M}"),
        ),
        (_F["reason"], _plain(said.reason)),
        (_F["advised"], one.advised(treatment)),
    ]


def _plain(text: str) -> str:
    return " ".join(text.split())


# -- the inspections


def _inspections(one: _PlotRecord) -> Iterator[Table]:
    """Yield which plants were inspected, day by day and by whom, page by page."""
    done = one.done
    rows: list[tuple[str, ...]] = []
    days, first = np.unique(done.date, return_index=True)  # they are in order
    for day, (a, b) in zip(days.tolist(), pairwise([*first.tolist(), len(done)]), strict=True):
        of = done.take(slice(a, b))
        found = int(np.count_nonzero(of.result == FOUND))
        by = _by(of, one.also.get(str(day), Counter()))
        if authors := ", ".join(sorted(one.corrected.get(str(day), set()) - {""})):
            by.append(worded(words.CERT_CORRECTED, who=authors))
        rows.append((one.units.day(day), figure(len(of)), figure(found), joined(", ", by)))
    title = worded(words.CERT_OF_PLOT, plot=one.name)
    if not rows:
        rows = [(words.CERT_NONE, "", "", "")]
    table = Table(
        title, words.CERT_DAY_COLUMNS, tuple(rows), (0.24, 0.2, 0.16, 0.4), flow=2, left=(0, 3),
        whole=True,
    )  # fmt: skip
    yield from _parts(table, _DAYS_A_PAGE)


def _by(done: Inspections, also: Counter[str]) -> list[str]:
    """Return who inspected, each with how many where there are several; nobody named comes last.

    `also` are those who recorded the same as somebody.
    """
    who = Counter(map(str, done.who.tolist())) + also
    names = [*sorted({*who} - {""}), *[""] * ("" in who)]
    said = {name: words.isolated(name) if name else words.CERT_NOT_SAID for name in names}
    if len(names) == 1:
        return [worded("{who}", who=said[names[0]])]
    return [worded("{who} {n:,}", who=said[name], n=who[name]) for name in names]
