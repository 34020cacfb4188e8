"""Files of a command become a plot, and what there is to say of them is said at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.cli.messages import Terminal

if TYPE_CHECKING:
    from fieldmon.io.prepared import Estate, Prepared
    from fieldmon.io.sources import PlotRequest


def prepared(request: PlotRequest, terminal: Terminal | None = None) -> Prepared:
    """Return the plot that a command is about."""
    from fieldmon.io.prepare import prepare

    terminal = terminal or Terminal()
    with terminal.answering():
        return prepare(request, terminal)


def estate(request: PlotRequest, terminal: Terminal | None = None) -> Estate:
    """Return the plots that a command is about."""
    from fieldmon.io.prepare import prepare_estate

    terminal = terminal or Terminal()
    with terminal.answering():
        return prepare_estate(request, terminal)
