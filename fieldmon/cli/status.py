"""`fieldmon status`: where a season stands. Heavy imports wait."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import (
    assumed_in_words,
    how_to_say_wait,
    tell_drafts,
    tell_found_again,
)
from fieldmon.cli.options import LastDate, SeasonFile
from fieldmon.cli.season_files import default_date, learnt_of_each, season_of
from fieldmon.cli.times import day

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    from fieldmon.monitoring import Season, Status
    from fieldmon.monitoring.inspecting.batches import BatchContents

#: batches of which it is listed what they say
_DETAILED = 100
#: plants of which it is listed how results contradict
_CONTRADICTING = 5
#: planned days that are listed, the last ones
_PLANNED_ONLY = 3
# of those with whose inspections another detection was said, so many are listed
_MOST_SAID = 8

ListBatches = Annotated[
    bool,
    typer.Option("--batches", help="List what was recorded, with the numbers for fieldmon undo."),
]
ListRows = Annotated[
    bool, typer.Option("--rows", help="List the days since each row was inspected.")
]


def status(
    season: SeasonFile,
    on: LastDate = None,
    batches: ListBatches = False,  # noqa: FBT002 - a flag
    rows: ListRows = False,  # noqa: FBT002 - a flag
) -> None:
    """Show where a season stands: what was found, what is still expected, and a forecast.

    Example: fieldmon status season.gpkg
    """
    kept = season_of(season)
    tell_drafts(kept.drafts)
    with kept.store.one_moment():
        _show(kept, kept.status(default_date(kept, day(on))), batches=batches, rows=rows)


def _show(kept: Season, now: Status, *, batches: bool, rows: bool) -> None:
    from fieldmon.monitoring.estimates.verifying import is_short

    typer.echo("\n".join(lines(kept, now)))
    typer.echo(f"  forecast               {kept.forecast(now.on).sentence()}")
    if assumed := assumed_in_words(kept.plot.assumed):
        typer.echo(f"  assumed of its rows    {assumed}")
    for line in (*_contradicting(kept, now.on), *of_treatments(kept, now)):
        typer.echo(line)
    if rows:
        _show_rows(kept, now)
    if batches:
        _show_batches(kept)
    tell_found_again(kept, now.on)
    whole = is_short(kept)
    for sentence in kept.verify(whole=whole):
        typer.echo(f"doubtful: {sentence}", err=True)
    if not whole:
        typer.echo(
            "checked against their digests: the last mornings only; fieldmon log --mornings checks "
            "the rest",
            err=True,
        )


def _contradicting(season: Season, on: date) -> Iterator[str]:
    """Yield of which plants two people said otherwise on a day, line by line."""
    from fieldmon.monitoring.inspecting.contradictions import contradiction_lines

    said = contradiction_lines(season.inspections.on(on), season.plot.grid)
    for line in said[:_CONTRADICTING]:
        yield f"  contradiction          {line}"
    if (more := len(said) - _CONTRADICTING) > 0:
        yield f"  {'':22} and {more} more"
    if said:
        yield f"  {'':22} Look again, and take back what is wrong with: fieldmon undo"


def _show_batches(kept: Season) -> None:
    from fieldmon.compute.wording import counted
    from fieldmon.plot.local_clock import local_clock

    clock, told = local_clock(kept.plot.field), kept.batches()
    contents = kept.contents([batch.number for batch in told[:_DETAILED]])
    for batch in told:
        at = clock.at(datetime.fromisoformat(batch.at))
        said, what = contents.get(batch.number), ""
        who = f" by {batch.by(said)}" if batch.by(said) else ""
        if said is not None and batch.kind == "treatment":
            what = f"  {counted(said.n, 'plant')}, {said.first}"
        elif said is not None and said.n == batch.rows == 1:
            row = kept.plot.grid.line_signs.get(said.row, said.row)
            what = f"  row {row}, plant {said.number_on(kept.plot.grid)}: {said.called}"
        elif said is not None and (batch.undone or said.counting == batch.rows):
            what = f"  {said.found} found"
        elif said is not None:
            of = f", {said.found} found" if said.counting else ""
            what = f"  {said.counting} {'counts' if said.counting == 1 else 'count'}{of}"
        if said is not None and batch.kind == "findings":
            what += _other_days(said, at.date())
        kind = batch.kind.removesuffix("s") + "s" * (batch.rows != 1)
        undone = "  (undone)" if batch.undone else ""
        if batch.stands_back(said):
            other = said is not None and said.corrected
            undone = "  (corrected since)" if other else "  (counts in another batch)"
        typer.echo(
            f"{batch.number:5d}  {at:%Y-%m-%d %H:%M}  {batch.rows:5d} {kind}{who}  "
            f"{batch.source}{what}{undone}"
        )


def _other_days(said: BatchContents, recorded: date) -> str:
    """Return when a batch was inspected, if not on the day on which it was recorded."""
    days = list(dict.fromkeys((said.first, said.last)))
    return "" if days == [str(recorded)] else f", inspected {' to '.join(days)}"


def lines(season: Season, now: Status) -> Iterator[str]:
    """Yield where a season stands, line by line."""
    from fieldmon.monitoring.estimates.what_was_told import earlier_season_note

    yield from _of_inspections(season, now)
    yield from _planned_only(season, now.on)
    yield from _of_infestation(now)
    yield from _of_learnt(season, now)
    yield from _told_otherwise(season, now.on)
    if (taught := earlier_season_note(season)) is not None:
        yield f"  an earlier season      {taught}"
    yield from _of_pest(season, now)
    yield _of_hot_spots(now)
    if len(records := season.records_known()):
        yield f"  {'':22} {records.sentence()}"


def _of_inspections(season: Season, now: Status) -> Iterator[str]:
    """Yield how much was inspected, what was found, and what could not be inspected."""
    from fieldmon.compute.wording import counted, share_figure

    yield f"{season.plot.field.name}, {now.on} (day {now.day + 1} of the season)"
    yield f"  inspected that day     {now.inspected_today:6,}, {now.found_today:,} found infested"
    yield (
        f"  inspected so far       {now.inspected:6,} of {counted(now.plants, 'plant')} "
        f"({share_figure(now.inspected / now.plants)}), {now.found:,} found infested"
        + (f" ({now.finds:,} finds: some again)" if now.finds > now.found else "")
    )
    if now.skipped:
        yield (
            f"  could not be inspected {now.skipped:6,} last time, {now.left_out:,} of them left "
            "out of the next day's plan"
        )
    yield from _gone(season, now)


def _of_infestation(now: Status) -> Iterator[str]:
    """Yield how many are believed infested still, and which share of them was found."""
    from fieldmon.compute.wording import chance_figure, estimate
    from fieldmon.monitoring.estimates.day_figures import flagged_said

    still, ahead = now.infested, now.estimate
    yield (
        f"  still infested         {estimate(still.expected):>6} ({still.low:,} to {still.high:,} "
        "with a chance of 90 %)"
    )
    for said in flagged_said(ahead, now.flagged):
        yield f"  {'':22} {said}"
    yield f"  share found            {_share_found(now)}"
    yield f"  chance it is clean     {chance_figure(ahead.chance_clean, 1):>8}"


def _of_learnt(season: Season, now: Status) -> Iterator[str]:
    """Yield what the season's own inspections tell of the insects."""
    from fieldmon.compute.wording import chance_figure
    from fieldmon.infestation.learnt import worth_saying

    since = "learnt so far" if now.inspected else "believed at first"
    for number, learnt in enumerate(worth_saying(now.learnt)):
        yield f"  {'' if number else since:22} {learnt.sentence()}"
        if learnt.name == "detection":
            yield from _of_who_inspects(season, now, str(chance_figure(learnt.value)))
    if now.learnt:
        yield f"  {'':22} In brackets: intervals that hold with a chance of 90 %."
    else:
        yield "  finds are traced       to neighbours only; fieldmon change --trace goes farther"


def _of_hot_spots(now: Status) -> str:
    """Return how many hot spots there are, and what was found in the first of them."""
    from fieldmon.compute.wording import estimate

    spots = now.hot_spots
    return f"  hot spots              {len(spots):6d}" + "".join(
        f"; {spots.found[h]} finds where {estimate(spots.expected[h])} were expected"
        for h in range(min(len(spots), 3))
    )


def _share_found(now: Status) -> str:
    """Return which share of the infested plants was found; of no inspections none is known."""
    if not now.inspected:
        return "not known: nothing was inspected yet"
    from fieldmon.compute.wording import chance_figure

    share, least, most = (
        chance_figure(pct / 100) for pct in (now.detection_pct, *now.detection_range_pct)
    )
    return f"{share:>8} ({least} to {most}) of found and not found yet"


def _of_pest(season: Season, now: Status) -> Iterator[str]:
    """Yield the pest, what is assumed of it, and how far it is, if one is named."""
    if (pest := season.settings.pest) is not None:
        yield f"  pest                   {pest.title or pest.name}"
        if pest.assumed:
            yield f"  {'':22} assumed: {assumed_in_words(pest.assumed)}"
    if now.development is not None:
        stage = f" ({now.development.stage})" if now.development.stage else ""
        yield f"  its development        {now.development.sentence()}{stage}"
        if guessed := int(now.development.guessed[: now.development.elapsed].sum()):
            are = "is" if guessed == 1 else "are"
            yield f"  {'':22} {guessed} of its days {are} filled in: no weather known"


def _gone(season: Season, now: Status) -> Iterator[str]:
    """Yield how many plants do not stand there any more, if any."""
    from fieldmon.monitoring.estimates.plant_states import gone_by_note_alone

    if n := int(season.history.gone(now.day).sum()):
        stand = "does not stand there any more: plans leave it out" if n == 1 else (
            "do not stand there any more: plans leave them out"
        )  # fmt: skip
        yield f"  gone                   {n:6,} {stand}"
    by_note, note = gone_by_note_alone(season.history, now.day)
    if by_note:
        are, stands = ("is", "it still stands") if by_note == 1 else ("are", "one still stands")
        yield (
            f"  {'':22} Of these, {by_note:,} {are} gone by a note alone ({note!r}), which counted "
            f"as skipped before version 0.2. If {stands}, inspect it again."
        )


def _of_who_inspects(season: Season, now: Status, of_all: str) -> Iterator[str]:
    """Yield what those who inspect on a day find, where they find otherwise than all until then."""
    by = season.planned_by(now.on)
    detects = {one.detects for one in [member.robot for member in by.team] or [by.robot]}
    history = season.history
    that_day = {*history.detections[history.days == now.day].tolist()}
    if detects == {history.mean_detection(now.day)} or that_day - detects:
        return  # it takes seconds to work out, or with some of them another one was said
    for whose, _, learnt in learnt_of_each(season, now.on):
        if learnt != of_all:
            yield f"  {'':22} Inspections{whose or ' of that day'} find {learnt}."


def _told_otherwise(season: Season, until: date) -> Iterator[str]:
    """Yield with which inspections another detection was said than the season's own."""
    said = season.other_detections(until)
    lines = [str(one.sentence()) for one in said[:_MOST_SAID]]
    if len(said) > _MOST_SAID:
        lines.append(f"And {len(said) - _MOST_SAID} more.")
    for number, one in enumerate(lines):
        yield f"  {'' if number else 'told to find':22} {one}"


def _planned_only(season: Season, until: date) -> Iterator[str]:
    """Yield which planned days nothing is recorded of."""
    from fieldmon.compute.wording import counted
    from fieldmon.monitoring.days.kept_routes import planned_only

    if missing := planned_only(season, until):
        some = ", ".join(map(str, missing[-_PLANNED_ONLY:]))
        n = len(missing) - _PLANNED_ONLY
        more = f"{counted(n, 'day')} and " if n > 0 else ""
        yield f"  planned, not recorded  {more}{some}"
        yield f"  {'':22} Record it; if nobody went, record one stop as skipped."


def of_treatments(season: Season, now: Status) -> Iterator[str]:
    """Yield what treatments ask for, and whether they worked, line by line."""
    from fieldmon.monitoring.treating.cautions import harvest_unsaid

    if (first := season.harvest_from(now.on)) is not None:
        from_when = f"from {first[0]} on, after the treatment of {first[1].on}"
        yield f"  {'harvest':22} {from_when if first[0] else harvest_unsaid(first[1])}"
        if first[0] is None:
            yield f"  {'':22} {how_to_say_wait(season.path, first[1])}"
    for number, effect in enumerate(one for one in season.effects(now.on) if one.before.inspected):
        yield f"  {'' if number else 'as treatments worked':22} {effect.sentence()}"
    for caution in dict.fromkeys(one.sentence for one in season.cautions(now.on)):
        yield f"  warning                {caution}"


def _show_rows(season: Season, now: Status) -> None:
    import numpy as np

    from fieldmon.compute.wording import counted

    grid = season.plot.grid
    lines, signs = grid.row_line_number, grid.line_signs
    wide = max(4, *map(len, signs.values()))
    for line in np.unique(lines):
        days = now.days_since[lines == line]
        known = days[~np.isnan(days)]
        said = f"{counted(round(known.min()), 'day')} ago" if len(known) else "never"
        typer.echo(f"  row {signs[line]:>{wide}}  {said}")
