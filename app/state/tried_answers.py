"""What each answer to an import's question would make of the file: for choosing by looking."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldmon.errors import ChoiceNeeded, FieldmonError
from fieldmon.io.options import PlotOptions
from fieldmon.plot.local_clock import local_clock

from . import brought_files, cached
from .brought_files import PLOT, settled

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

#: what leads to plots at different places, or of different shapes
_SEEN = frozenset({"crs", "swap_axes", "layer", "where", "columns", "units", "member"})
# each is read once, in a process of its own
_MOST = 12


@dataclass(frozen=True, eq=False)
class TriedAnswer:
    """An answer, the plots that it leads to, and the time zone in which they lie; none: neither."""

    answer: str
    plots: tuple[Field, ...] = ()
    zone: str = ""


def tried(problem: FieldmonError | None) -> tuple[TriedAnswer, ...]:
    """Return each answer to a question about the plot's file, tried; nothing of other problems."""
    file = brought_files.brought().get(PLOT)
    if not isinstance(problem, ChoiceNeeded) or file is None:
        return ()
    if brought_files.asking() != file.asked or problem.option not in _SEEN:
        return ()
    options = settled(file, PlotOptions())
    made = []
    for answer in map(str, problem.choices[:_MOST]):
        try:
            read = cached.plots(file.key, options.choose(problem.option, answer), file.source)
            made.append(TriedAnswer(answer, read.value, local_clock(read.value[0]).zone))
        except FieldmonError:  # nothing to look at; the answer can be given all the same
            made.append(TriedAnswer(answer))
    return tuple(made)
