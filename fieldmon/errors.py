"""What can go wrong, one class per thing a caller could do about it.

Every message is a sentence or two: what must hold, what was found, where, and what to do.
The command line prints it and ends with exit code 2; the app shows it. Nothing is written before.
"""

from __future__ import annotations


class FieldmonError(Exception):
    """Any problem that a person can put right; its text is meant for that person."""


class FileProblem(FieldmonError):  # noqa: N818 - reads as what it is
    """A file cannot be used as it is: choose or mend another file."""


class ChoiceNeeded(FieldmonError):  # noqa: N818
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
        Which file asks, where a plot is prepared from several (`fieldmon.io.sources.Role`).
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
    """A setting is outside what it may be: change the number."""


class ImportDoubt(UserWarning):
    """An import guessed, dropped or doubts something: look before you use it."""


class PlotError(FieldmonError):
    """The plot cannot carry what was asked (no room for a plant, no way between rows)."""


class ObservationError(FieldmonError):
    """The observations do not fit the plot or their own columns."""


class ContradictionError(ObservationError):
    """Results contradict what is recorded of the same day: confirm them, or leave them out."""


class AccessError(FieldmonError):
    """A key is unknown or was taken back: ask whoever leads the season for a new one."""


class LimitError(FieldmonError):
    """More was sent than is taken at once or in a day: send less, or later."""
