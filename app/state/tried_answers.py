"""What each answer to an import's question would make of the file: for choosing by looking."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import ChoiceNeeded, FieldmonError
from fieldmon.infestation.records import PRESENT
from fieldmon.io.options import PlotOptions, RecordOptions
from fieldmon.io.read import read_plots, read_records
from fieldmon.io.readers.nearby import records_on_plot
from fieldmon.plot.local_clock import clock_at, local_clock

from ..words.answers import in_short
from . import brought_files, cached_files
from .brought_files import PLOT, settled

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.infestation.records import Records
    from fieldmon.plot.field import Field

    from .brought_files import File, LeftOut

    #: reads the file as an answer has it
    Make = Callable[[str], "TriedAnswer"]

#: what leads to plots at different places, or of different shapes
_SEEN = frozenset({"crs", "swap_axes", "layer", "where", "columns", "units", "member"})
#: what leads to records at different places, or to other finds
_SEEN_OF_RECORDS = _SEEN | {"degrees", "encoding", "sheet"}
# each is read once, in a process of its own
_MOST = 12
# one question may lead to another, whose first answer is taken to have something to look at
_MOST_QUESTIONS = 4


@dataclass(frozen=True, eq=False)
class TriedAnswer:
    """An answer and what it leads to; neither plots nor records: nowhere.

    Parameters
    ----------
    answer
        As it is handed back.
    plots
        The plots that it leads to.
    zone
        The time zone in which they lie; empty: unknown.
    records
        The records that it leads to, wherever they lie; None: it is no question about records.
    near
        How many of them lie on the plot or near it.
    option
        What is asked.
    """

    answer: str
    plots: tuple[Field, ...] = ()
    zone: str = ""
    records: Records | None = None
    near: int = 0
    option: str = ""

    @property
    def said(self) -> str:
        """Return the answer in a grower's words."""
        return in_short(self.answer, self.option)

    @property
    def leads(self) -> bool:
        """Return whether there is something to look at."""
        return bool(self.plots) or self.records is not None

    @property
    def finds(self) -> int:
        """Return how many of the records are finds."""
        return 0 if self.records is None else int((self.records.present == PRESENT).sum())


def tried(problem: FieldmonError | None) -> tuple[TriedAnswer, ...]:
    """Return each answer to a question about the plot's file, tried; nothing of other problems."""
    file = brought_files.brought().get(PLOT)
    if not isinstance(problem, ChoiceNeeded) or file is None:
        return ()
    if brought_files.asking() != file.asked or problem.option not in _SEEN:
        return ()
    return _each(problem, file, partial(_plots, problem.option, file, settled(file, PlotOptions())))


def tried_of_records(left_out: LeftOut, field: Field) -> tuple[TriedAnswer, ...]:
    """Return each answer to a question about records, tried; nothing of other problems."""
    problem, file = left_out.problem, left_out.file
    if not isinstance(problem, ChoiceNeeded) or problem.option not in _SEEN_OF_RECORDS:
        return ()
    options = settled(file, RecordOptions())
    return _each(problem, file, partial(_records, problem.option, (file, options), field))


def _each(problem: ChoiceNeeded, file: File, make: Make) -> tuple[TriedAnswer, ...]:
    before = f"{file.asked} {brought_files.answers(file.asked)} {problem.option}"
    return tuple(
        replace(
            cached_files.tried(f"{before} {answer}", partial(make, answer)), option=problem.option
        )
        for answer in map(str, problem.choices[:_MOST])
    )


def _plots(option: str, file: File, options: PlotOptions, answer: str) -> TriedAnswer:
    try:
        plots = read_plots(file.source, options.choose(option, answer)).value
    except FieldmonError:  # nothing to look at; the answer can be given all the same
        return TriedAnswer(answer)
    return TriedAnswer(answer, plots, local_clock(plots[0]).zone)


def _records(
    option: str, of: tuple[File, RecordOptions], field: Field, answer: str
) -> TriedAnswer:  # fmt: skip
    file, options = of
    options = options.choose(option, answer)
    for _ in range(_MOST_QUESTIONS):
        try:
            records = read_records(file.source, options).value
        except ChoiceNeeded as more:
            if not more.choices:
                break
            options = options.choose(more.option, str(more.choices[0]))
        except FieldmonError:
            break
        else:
            if not len(records):
                break
            lon, lat = np.median(records.lonlat, axis=0).tolist()
            near = len(records_on_plot(records, field))
            return TriedAnswer(answer, (), clock_at(lon, lat).zone, records, near)
    return TriedAnswer(answer)
