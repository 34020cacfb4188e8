"""Labels of products read in one call, for the public library, as `fieldmon.io.library` reads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.decisions.label_file import read_labels as read_label_file
from fieldmon.io.library_calls import must_be_file, warn_of

if TYPE_CHECKING:
    from fieldmon.decisions.labels import ProductLabel
    from fieldmon.io.options import Upload


def read_labels(source: str | Path | Upload) -> tuple[ProductLabel, ...]:
    r"""Return what labels allow, from your own table of products.

    Parameters
    ----------
    source
        Path of a CSV file with a column ``product``, and any of ``crop``, ``pest``, ``max_dose``,
        ``unit``, ``waiting_days``, ``reentry_hours``, ``irac_group``, ``max_uses``, ``source``.

    Returns
    -------
    tuple of ProductLabel
        One for each line; `Season.keep_labels` takes them.

    Warns
    -----
    ImportDoubt
        For everything that is doubtful.

    Raises
    ------
    FileProblem
        If it cannot be read, or a line is no label: which line, and why.

    Examples
    --------
    >>> import fieldmon as fm
    >>> with open("labels.csv", "w") as file:
    ...     _ = file.write("product,crop,waiting_days\nSome oil,grapes,7\n")
    >>> fm.read_labels("labels.csv")[0].waiting_days
    7
    """
    must_be_file(source)
    read = read_label_file(Path(source) if isinstance(source, str) else source)
    warn_of(read.messages)
    return read.value
