"""How plots and blocks are called: by which column, and told apart where names repeat."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, guessed, seen
from fieldmon.io.parse.columns import find, plain

if TYPE_CHECKING:
    from fieldmon.io.options import PlotOptions


def plot_names(layer: Layer, column: str | None) -> tuple[list[str], list[ImportMessage]]:
    """Return a different name for every feature, and where the names come from."""
    named = column or name_column(layer)
    messages: list[ImportMessage] = []
    if named is None:
        base = [layer.plot_name] * len(layer)
        if len(layer) > 1:
            messages.append(
                guessed(worded("No column was recognised as the plots' names; they are numbered."))
            )
    else:
        try:
            cells = layer.column(named)
        except ChoiceNeeded as asked:
            raise ChoiceNeeded(asked.args[0], "name_column", asked.choices) from None
        base = [text(v) or layer.plot_name for v in cells]
        if len(layer) > 1 or column is None:
            messages.append(seen(worded("Plots are named by column {name!r}.", name=named)))
    return told_apart(base), messages


def block_names(areas: Layer, options: PlotOptions) -> tuple[list[str], list[str]]:
    """Return the plot and the block of each feature; without names all are of one plot."""
    column = options.column("block") or ""
    blocks = [text(value) for value in areas.column(column)]
    others = {name: values for name, values in areas.columns.items() if name != column}
    named = options.name_column or name_column(replace(areas, columns=others))
    if named is None:
        return [areas.name] * len(areas), blocks
    return [text(value) or areas.name for value in areas.column(named)], blocks


def name_column(layer: Layer) -> str | None:
    """Return the column that names plots: the first that says anything, by what it is called."""
    said = [name for name in layer.columns if any(text(v) for v in layer.columns[name])]
    return find("name", said) or next((name for name in said if "name" in plain(name)), None)


def told_apart(names: list[str]) -> list[str]:
    """Return names that differ: those that repeat are numbered."""
    total, so_far = Counter(names), Counter[str]()
    apart = []
    for name in names:
        so_far[name] += 1
        apart.append(name if total[name] == 1 else f"{name} ({so_far[name]})")
    return apart
