"""What can go wrong, one class per thing a caller could do about it.

Every message is a sentence or two: what must hold, what was found, where, and what to do.
The command line prints it and ends with exit code 2; the app shows it. Nothing is written before.
"""

from __future__ import annotations


class FieldmonError(Exception):
    """Any problem that a person can put right; its text is meant for that person.

    Examples
    --------
    >>> import fieldmon as fm
    >>> try:
    ...     fm.Robot(hours=-1)
    ... except fm.FieldmonError as problem:
    ...     print(problem)
    The robot's hours must be above 0, not -1.
    """


class FileProblem(FieldmonError):  # noqa: N818 - a question, not an error - reads as what it is
    """A file cannot be used as it is: choose or mend another file.

    Examples
    --------
    >>> import fieldmon as fm
    >>> try:
    ...     fm.read_plot("nowhere.zip")
    ... except fm.FileProblem:
    ...     print("Which file, then?")
    Which file, then?
    """


class ChoiceNeeded(FieldmonError):  # noqa: N818 - a question, not an error
    """The file holds more than one answer, or lacks one: the caller must choose.

    Parameters
    ----------
    message
        The sentence for the person.
    option
        What has to be chosen: ``"layer"``, ``"feature"``, ``"crs"``, ``"member"``, ``"columns"``...
    choices
        The possible answers, best first, as they can be handed back.
    role
        Which file asks, where a plot is prepared from several (`fieldmon.io.plot_request.Role`).

    Examples
    --------
    >>> import fieldmon as fm
    >>> try:
    ...     fm.read_plot("sample_data/paran_estate.zip")
    ... except fm.ChoiceNeeded as question:
    ...     print(question.option, question.choices[:2])
    feature ('Gate', 'Pond')
    """

    def __init__(
        self, message: str, option: str, choices: tuple[str, ...] = (), role: str = ""
    ) -> None:
        super().__init__(message)
        self.option = option
        self.choices = choices
        self.role = role

    def __reduce__(self) -> tuple[type[ChoiceNeeded], tuple[str, str, tuple[str, ...], str]]:
        return type(self), (self.args[0], self.option, self.choices, self.role)


class SettingError(FieldmonError):
    """A setting is outside what it may be: change the number.

    Examples
    --------
    >>> import fieldmon as fm
    >>> try:
    ...     fm.Spread(rate_per_day=30)
    ... except fm.SettingError as problem:
    ...     print(problem)
    The spread's rate_per_day must be a chance in 0..1, but it is 30.
    """


class ImportDoubt(UserWarning):
    """An import guessed, dropped or doubts something: look before you use it.

    Examples
    --------
    >>> import warnings
    >>> import fieldmon as fm
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", fm.ImportDoubt)  # refuse what is doubted
    ...     plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    """


class PlotError(FieldmonError):
    """The plot cannot carry what was asked (no room for a plant, no way between rows).

    Examples
    --------
    >>> import fieldmon as fm, shapely
    >>> try:
    ...     fm.Field("nothing", shapely.MultiPolygon())
    ... except fm.PlotError as problem:
    ...     print(str(problem).partition(", but")[0])
    The boundary of plot 'nothing' must be a valid, non-empty area
    """


class NoRowsError(PlotError):
    """Measured plants show no rows: add plants, or say that they stand in none.

    Examples
    --------
    >>> import numpy as np, fieldmon as fm
    >>> try:
    ...     fm.Plot.around("one", np.array([[35.15, 30.36]]))
    ... except fm.NoRowsError as problem:
    ...     print(str(problem).partition(", but")[0])
    Rows can be found from 2 plants or more
    """


class ObservationError(FieldmonError):
    """What was observed, records or inspections, does not fit the plot or its own columns.

    Examples
    --------
    >>> import fieldmon as fm
    >>> try:
    ...     fm.Records.of([[35.15, 30.36]], [1, 1])
    ... except fm.ObservationError as problem:
    ...     print(problem)
    All columns of the records must have 1 entries, but present has 2.
    """


class ContradictionError(ObservationError):
    """Results contradict what is recorded of the same day: confirm them, or leave them out.

    `Season.contradictions` tells which; ``record(..., confirmed=True)`` lets both count, and
    `Season.record_instead` those that come last.

    Examples
    --------
    >>> import fieldmon as fm
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Nursery")
    >>> season = fm.Season.create("of_contradictions.gpkg", plot, begins="2026-11-18")
    >>> _ = season.record(fm.Inspections.of([7], [0], "2026-11-18"))
    >>> found = fm.Inspections.of([7], [1], "2026-11-18")
    >>> try:
    ...     season.record(found)
    ... except fm.ContradictionError:
    ...     print(season.record_instead(found).corrected)
    1
    """


class AccessError(FieldmonError):
    """A key is unknown or was taken back: ask whoever leads the season for a new one."""


class LimitError(FieldmonError):
    """More was sent than is taken at once or in a day: send less, or later."""
