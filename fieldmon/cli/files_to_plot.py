"""Files of a command become a plot, and what there is to say of them is said at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldmon.cli.messages import Terminal, tell_unusable

if TYPE_CHECKING:
    from datetime import date

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.io.plot_request import PlotRequest
    from fieldmon.io.prepared_plots import Estate, Prepared


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


def believed(known: Prepared, day: date, prior: PriorSettings) -> NDArray[np.float64]:
    """Return each plant's chance of infestation on a day; say which records tell nothing of it."""
    import numpy as np

    from fieldmon.infestation.prior.prior import prior_chance

    plot, on = known.plot, np.datetime64(day, "D")
    tell_unusable(known.records, on, prior)
    return prior_chance(plot.grid, plot.field, known.records, on, prior, known.risk)
