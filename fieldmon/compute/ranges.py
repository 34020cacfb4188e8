"""What a number may be, and how a sentence says that it is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fieldmon.compute.wording import worded

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(frozen=True)
class AllowedRange:
    """From the least number to the most.

    Parameters
    ----------
    least, most
        Its ends.
    above, below
        Whether the least, or the most, is itself no part of it.
    unit
        What stands behind its ends in a sentence: ``" km/h"``.
    said
        How it is said whichever end was passed; empty: by that end.

    Examples
    --------
    >>> hours = AllowedRange(0, 24, above=True, unit=" h")
    >>> hours.broken(0), hours.broken(25), hours.broken(24)
    ('above 0 h', '24 h at most', '')
    >>> CHANCE.broken(30)
    'a chance in 0..1'
    """

    least: float
    most: float
    above: bool = False
    below: bool = False
    unit: str = ""
    said: str = ""

    def broken(self, value: float) -> str:
        """Return what a number must be and is not; empty where it may be so."""
        # so that what is no number is in none
        if not (value > self.least if self.above else value >= self.least):
            least = {"least": self.least, "unit": self.unit}
            if self.above:
                return self.said or worded("above {least:.12g}{unit}", **least)
            return self.said or worded("{least:.12g}{unit} or more", **least)
        if not (value < self.most if self.below else value <= self.most):
            most = {"most": self.most, "unit": self.unit}
            if self.below:
                return self.said or worded("below {most:.12g}{unit}", **most)
            return self.said or worded("{most:.12g}{unit} at most", **most)
        return ""


def broken_setting(settings: object, ranges: Mapping[str, AllowedRange]) -> dict[str, Any] | None:
    """Return the first of some settings that is outside its range; None: all are as they may be.

    Returns
    -------
    dict
        Its ``name`` and ``value``, and the ``rule`` that it breaks. What is None breaks none.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> broken_setting(SimpleNamespace(days=-1), {"days": DAYS})
    {'name': 'days', 'rule': '1 or more', 'value': -1}
    """
    for name, allowed in ranges.items():
        value = getattr(settings, name)
        if value is not None and (rule := allowed.broken(value)):
            return {"name": name, "rule": rule, "value": value}
    return None


CHANCE = AllowedRange(0.0, 1.0, said=worded("a chance in 0..1"))
#: of an inspection that may find something, to see what is there
DETECTS = AllowedRange(0.0, 1.0, above=True, said=worded("above 0, and 1 at most"))
#: of something of which there are some, and others
SHARE = AllowedRange(0.0, 1.0, above=True, below=True, said=worded("a share between 0 and 1"))
SURE = AllowedRange(0.5, 1.0, above=True, below=True, said=worded("a chance between 0.5 and 1"))
#: how sure a season's advice is unless somebody says otherwise
USUAL_SURE = 0.9
#: what a season file can hold, and a generator of random numbers takes
SEED = AllowedRange(0, 2**63 - 1, said="a whole number from 0 to 2^63 - 1")
#: numbers of batches and rows in a season file
NUMBER = AllowedRange(1, 2**63 - 1, said="a whole number from 1 to 2^63 - 1")
#: nobody simulates more
SEASONS = AllowedRange(1, 1_000_000)
#: of which differences have an interval
PAIRED = AllowedRange(2, 1_000_000)
DAYS = AllowedRange(1, 3650)
#: nobody has counted more on a plant
MOST_COUNTED = 1e9
MONEY = AllowedRange(0.0, 1e9)
