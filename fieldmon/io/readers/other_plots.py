"""Which inspections of a file are of another plot, by the plot that they name.

Decisions
---------
- A position says more than a name: only records without one are told apart by name. Those that
  name another plot and lie on this one are taken, with a doubt.
- Not so in a table exported from seasons, where a name is a season's own: two seasons may be of
  one plot, and a plant that only doubtfully is the one meant may be of a plot far away.
- Where some record names this plot, those that name others are left out. Where none does, the
  names may be another way to call it: that is a doubt, and one can say that they are its own.
- Of blocks and of places wider than a plot (`_NOT_ONLY_PLOTS`) a name is one of a plot only beside
  this plot's.
"""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.wording import first_few, worded
from fieldmon.infestation.nearby_plants import outside_m
from fieldmon.io.import_report import ImportMessage, Remedy, doubtful, dropped
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.readers.places import of_other_plots

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fieldmon.io.readers.inspection_file.inspection_rows import InspectionRows
    from fieldmon.io.readers.inspection_options import InspectionOptions
    from fieldmon.plot.grid import PlantGrid

_NOT_ONLY_PLOTS = frozenset({"locality", "site"})
_OURS = Remedy("columns", "plot=", worded("They are of this plot"))


def of_this_plot(
    rows: InspectionRows, grid: PlantGrid, called: tuple[str, ...], options: InspectionOptions
) -> tuple[InspectionRows, list[ImportMessage]]:
    """Return the records that are of a plot `called` so, and what to say of the others."""
    if rows.plot_called is None or rows.plot_column is None or not called:
        return rows, []
    names = rows.plot_called
    ours = _ours(set(names.tolist()) - {""}, called)
    others = ~np.isin(names, ["", *ours])
    if not others.any():
        return rows, []
    if not ours and options.column("plot") is None and _may_be_else(str(rows.plot_column[0])):
        return rows, []
    placed = np.isfinite(rows.lonlat).all(axis=1) & ~rows.exported.any()
    kept, said = _by_name(rows, others & ~placed, called[0], options, is_named=bool(ours))
    return kept, [*said, *_lying_here(rows, others & placed, grid)]


def left_out(messages: Iterable[ImportMessage]) -> str:
    """Return why records that name other plots were left out; empty where none were."""
    out = (one.sentence for one in messages if one.remedy == _OURS)
    return next(out, "")


def _by_name(
    rows: InspectionRows, others: NDArray[np.bool_], plot: str, options: InspectionOptions,
    *, is_named: bool,
) -> tuple[InspectionRows, list[ImportMessage]]:  # fmt: skip
    """Leave out the records of `others`, and say so; `is_named`: some record names this plot."""
    if rows.plot_called is None or rows.plot_column is None or not others.any():
        return rows, []
    named = rows.plot_called[others].tolist()
    if is_named:
        return rows.take(~others), [dropped(of_other_plots(named), remedy=_OURS)]
    column = str(rows.plot_column[0])
    said = {
        "n": len(named),
        "column": column,
        "names": first_few(sorted(set(named))),
        "plot": plot,
    }
    if options.take_doubtful:
        taken = worded(
            "Column {column!r} names {names}, not plot {plot}: {n} {n:record was|records were} "
            "taken as asked.",
            **said,
        )
        return rows, [doubtful(taken)]
    left_out = worded(
        "Column {column!r} names {names}, not plot {plot}: {n} {n:record is|records are} "
        "doubtful and left out.",
        **said,
    )
    return rows.take(~others), [doubtful(left_out, remedy=_OURS)]


def _lying_here(
    rows: InspectionRows, others: NDArray[np.bool_], grid: PlantGrid
) -> list[ImportMessage]:
    """Return a doubt about records that name another plot, but lie on this one."""
    at = np.flatnonzero(others)
    at = at[outside_m(grid, rows.lonlat[at]) == 0]
    if rows.plot_called is None or not len(at):
        return []
    said = worded(
        "{n} {n:record names|records name} another plot ({names}), but {n:lies|lie} on this one: "
        "taken by {n:its position|their positions}.",
        n=len(at),
        names=first_few(sorted(set(rows.plot_called[at].tolist()))),
    )
    return [doubtful(said)]


def _may_be_else(column: str) -> bool:
    return plain(column) in _NOT_ONLY_PLOTS or find("block", [column]) is not None


def _ours(names: set[str], called: tuple[str, ...]) -> list[str]:
    """Return which names are this plot's, however they are written.

    A number alone is, where it is the only name and the one number in this plot's.
    """
    keys = {_key(name) for name in called}
    ours = [
        name
        for name in names
        if _key(name) in keys or any(_is_of_code_page(name, own) for own in called)
    ]
    if not ours and len(names) == 1 and (only := next(iter(names))).isdecimal():
        digits = "".join(c for c in called[0] if c.isdecimal())
        return [only] if digits and int(digits) == int(only) else []
    return ours


def _is_of_code_page(name: str, own: str) -> bool:
    """Return whether a name is one of this plot's, with ``?`` for what an old code page lacks."""
    return len(name) == len(own) and all(
        new == old or (new == "?" and not old.isascii()) for new, old in zip(name, own, strict=True)
    )


def _key(name: str) -> str:
    """Return a name without capitals, accents, spaces and marks; with what stands in brackets."""
    letters = unicodedata.normalize("NFKD", name.casefold())
    bare = "".join(c for c in letters if c.isalnum())
    return bare.lstrip("0") or bare or name.strip()
