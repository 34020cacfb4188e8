"""What imports have to say and to ask, as a person at a terminal reads and answers it."""

from __future__ import annotations

import shlex
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, time, timedelta
from typing import TYPE_CHECKING

import typer

from fieldmon.cli.times import day_on
from fieldmon.errors import ChoiceNeeded

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from datetime import date
    from pathlib import Path

    import numpy as np

    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.infestation.records import Records
    from fieldmon.io.prepared_plots import Laid, SourceMessage
    from fieldmon.monitoring import Season
    from fieldmon.monitoring.settings.settings import MonitoringSettings
    from fieldmon.monitoring.treating.treatments import KeptTreatment
    from fieldmon.plot.assumed import Assumed
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot

#: the options that take what a file leaves open, by what the file is to the plot
FLAGS = {
    "plot": "--plot-option",
    "plants": "--plants-option",
    "rows": "--rows-option",
    "blocks": "--blocks-option",
    "contours": "--contours-option",
    "paths": "--paths-option",
    "records": "--record-option",
    "canopy": "--canopy-option",
    "risk": "--risk-option",
    "findings": "--finding-option",
    "weather": "--weather-option",
}
#: questions that another file answers, not a value
_OTHER_FILES = {
    "kind": "Give points with --plants FILE and lines with --paths FILE (fieldmon plan).",
    "plots": "Give the file of the plots as the first argument.",
    "plants": "Give the plants with --plants FILE.",
}
#: what commands that have `FLAGS` also take by an option of its own
# plots that are named where something is so of some only
_NAMED = 3
# the options that say what was taken, where they are not called as it is
_OPTIONS = {"row_bearing_deg": "bearing"}
_BEARING = "row bearing "
_BY_NAME = frozenset({"crs", "layer", "feature"})


@dataclass(frozen=True)
class Terminal:
    """Prints what there is to say while a plot is prepared.

    Parameters
    ----------
    flags
        Options of the command that take what is left open.
    takes_rows
        Whether the command has options that say how the plot is planted.
    """

    flags: Mapping[str, str] = field(default_factory=lambda: FLAGS)
    takes_rows: bool = True

    def message(self, said: SourceMessage) -> None:
        """Print what an import has to say, with the option that answers."""
        typer.echo(said.message.line(self.flags.get(said.role, "")), err=True)

    def laid(self, laid: Laid) -> None:
        """Print how the plot is planted."""
        describe(laid.plot)
        self.assumed(laid.assumed)
        for one in () if laid.plot.rows is None else laid.plot.rows.directions:
            could_be = f"could be: {one}, {one.row_spacing_m:.2f} m apart"
            typer.echo(self._with_row_option(could_be, f"bearing {one.bearing_deg:.1f}"), err=True)

    def assumed(self, assumed: Iterable[Assumed]) -> None:
        """Print what was taken for rows because nobody said it."""
        for one in assumed:
            option = _OPTIONS.get(one.setting, one.setting.removesuffix("_m").replace("_", "-"))
            typer.echo(self._with_row_option(str(one), option), err=True)

    def _with_row_option(self, sentence: str, option: str) -> str:
        return f"{sentence} [--{option}]" if self.takes_rows else sentence

    @contextmanager
    def answering(self) -> Iterator[None]:
        """Say with a question how to answer it on the command line."""
        try:
            yield
        except ChoiceNeeded as question:
            raise ChoiceNeeded(
                self._with_answer(question), question.option, question.choices, question.role
            ) from None

    def _with_answer(self, question: ChoiceNeeded) -> str:
        if question.option in _OTHER_FILES:
            return f"{question} {_OTHER_FILES[question.option]}" if self.flags else str(question)
        answer = question.choices[0] if question.choices else "..."
        if question.option == "feature" and not question.role:
            sentence = str(question).removesuffix(".")
            return f'{sentence}: --feature "{answer}" or --feature 1.'
        how = self._option(question)
        return f'{question} Answer with {how}"{answer}", for instance.' if how else str(question)

    def _option(self, question: ChoiceNeeded) -> str:
        """Return the option that answers a question, up to its value; empty if there is none."""
        flag, option = self.flags.get(question.role, ""), question.option
        if question.role == "plot" and option in _BY_NAME and (flag or option == "feature"):
            return f"--{option} "
        if option == "plot" and not flag:
            # where nothing can be said of records, one plot can be chosen for them
            return "--feature "
        return f"{flag} {option}=" if flag else ""


def describe(plot: Plot) -> None:
    """Print how a plot is planted."""
    from fieldmon.compute.wording import counted

    grid, name = plot.grid, plot.field.name
    if not grid.in_rows:
        typer.echo(f"{name}: {grid.counts}, visited by nearness.")
        return
    if plot.rows is not None and not plot.rows.in_rows:
        typer.echo(f"{name}: {counted(len(grid), 'plant')} in no rows.")
        return
    run = f"bearing {grid.frame.bearing_deg % 180:.1f} degrees"
    if grid.aisles_m is not None:
        run = f"which run as they bend, in {counted(grid.n_blocks, 'block')}"
    typer.echo(
        f"{name}: {counted(len(grid), 'plant')} in {counted(grid.n_lines, 'row')}, {run}, rows "
        f"{grid.row_spacing_m:.2f} m and plants {grid.plant_spacing_m:.2f} m apart."
    )


def tell_assumed(assumed: Iterable[Assumed]) -> None:
    """Print what the figures of a day rest on though nobody said it, in one line."""
    said = assumed_in_words(assumed)
    if said:
        typer.echo(f"assumed: {said}", err=True)


def tell_assumed_of_plots(assumed: Mapping[str, str]) -> None:
    """Print what was assumed of which plots, from one line of each: what is so of all, once."""
    from fieldmon.compute.wording import counted, first_few

    plots: dict[str, list[str]] = {}
    for plot, line in assumed.items():
        for one in line.split("; "):
            own = one.startswith(_BEARING) and len(assumed) > 1
            said = f"{_BEARING}along the longest side of each" if own else one
            plots.setdefault(said, []).append(plot)
    plots.pop("", None)
    said = "; ".join(
        one
        if len(named) == len(assumed)
        else f"{one} ({counted(len(named), 'plot')}: {first_few(named, _NAMED)})"
        for one, named in plots.items()
    )
    if said:
        typer.echo(f"assumed: {said}", err=True)


def assumed_in_words(assumed: Iterable[Assumed]) -> str:
    """Return what was assumed in one line, each apart by a semicolon."""
    return "; ".join(str(one).removeprefix("guessed: ") for one in assumed)


def tell_drafts(sentences: Iterable[str]) -> None:
    """Print which inspections that another program added do not count."""
    for sentence in sentences:
        typer.echo(sentence, err=True)


def tell_not_come(
    on: date, field: Field, what: str, todo: str = "take it back with: fieldmon undo"
) -> None:
    """Print that a day has not come yet on a plot, if so: a slip in a date moves a whole season.

    `todo` is what can be done if its date is wrong.
    """
    today = day_on(field, None)
    if on > today:
        typer.echo(
            f"doubtful: {what}, {on}, has not come: it is {today} on the plot. If its date is "
            f"wrong, {todo}",
            err=True,
        )


def tell_found_again(season: Season, on: date) -> None:
    """Print that plants were found again up to a day, though they are taken as treated."""
    from fieldmon.monitoring.estimates.figures_of_day import found_again

    if (said := found_again(season, on)) is not None:
        how = shlex.join(["fieldmon", "change", str(season.path), "--flag-only"])
        typer.echo(f"doubtful: {said.sentence(how)}", err=True)


def tell_clock_change(start: datetime, hours: float, field: Field) -> None:
    """Print that clocks are put back in a season's work, if so: an hour comes twice in its file."""
    from fieldmon.plot.local_clock import local_clock

    moved_min = local_clock(field).put_forward(start, 3600 * hours).total_seconds() / 60
    if moved_min < 0:
        typer.echo(
            f"doubtful: Clocks are put back by {-moved_min:.0f} min during this work: once "
            f"something found after that is recorded, {-moved_min:.0f} min too many of its hours "
            "are left.",
            err=True,
        )


def tell_past_midnight(on: date, settings: MonitoringSettings) -> None:
    """Print that a season's work goes past midnight, if so: times of then have another date."""
    start = datetime.combine(on, settings.starts)
    team = (timedelta(seconds=m.starts_s, hours=m.robot.hours) for m in settings.team)
    ends = start + max(team, default=timedelta(hours=settings.robot.hours))
    if ends.date() > start.date() and ends.time() != time():
        typer.echo(
            f"seen: The work goes past midnight, to {ends:%H:%M}: a result with a time after that "
            f"is of {ends.date()}, one of a route without a time of {on}. To plan the rest of the "
            f"work then, give --date {on}.",
            err=True,
        )


def tell_unusable(records: Records, day: np.datetime64, prior: PriorSettings) -> None:
    """Print of which days records are, and which say nothing, or hardly anything, about a day."""
    from fieldmon.infestation.records import usable

    known = usable(records, day, prior)
    if len(known.records):
        typer.echo(f"seen: {known.records.sentence()}", err=True)
    for sentence in known.messages():
        typer.echo(sentence, err=True)


def how_to_say_wait(season: Path, one: KeptTreatment) -> str:
    """Return how to say how long to wait from a treatment until harvest."""
    if product := one.application.product:
        pasted = shlex.join(["fieldmon", "labels", str(season), "--product", product])
        return f"Say it as its label does: {pasted} --waiting-days DAYS"
    pasted = shlex.join(["fieldmon", "undo", str(season), "--batch", str(one.batch)])
    return f"It names no product: {pasted}; then record it again with --product, --waiting-days"
