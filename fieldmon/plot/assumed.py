"""What nobody said and no file states, though figures rest on it."""

from __future__ import annotations

from dataclasses import dataclass

_SHARES = {"background_chance", "rate_per_day", "detects"}
_WORDS = {
    "background_chance": "chance of a plant of which nothing is known",
    "rate_per_day": "chance a night to infest a neighbour",
    "detects": "chance to find what is there",
    "speed_m_s": "speed",
    "hours": "working day",
    "look_s": "time to look at a plant",
    "half_canopy_m": "reach of plants to each side",
    "row_change_s": "time added for a row change, as in simulated drives:",
    "stop_s": "time added for a stop, as in simulated drives:",
    "treated": "plants found infested are treated at once",
}


@dataclass(frozen=True)
class Assumed:
    """Something that was taken because nobody said otherwise.

    Parameters
    ----------
    setting
        Its name where it can be said: ``"row_spacing_m"`` and ``"row_bearing_deg"`` of
        `PlantingChoices`,
        ``"half_canopy_m"`` of `Planting`,
        ``"background_chance"`` of `PriorSettings`, ``"rate_per_day"`` of `Spread`, ``"speed_m_s"``,
        ``"row_change_s"``, ``"stop_s"``, ``"look_s"``, ``"hours"`` and ``"detects"`` of `Robot`,
        ``"treated"`` of `BeliefSettings`.
    value
        What was taken: metres, degrees, metres a second, seconds, or a chance; 1: it is so.
    of
        Names of those of a team of whom it was taken; empty: of all.
    """

    setting: str
    value: float
    of: str = ""

    def __str__(self) -> str:
        return f"{self._said()} ({self.of})" if self.of else self._said()

    def _said(self) -> str:
        words = self.setting.removesuffix("_m").replace("_", " ")
        words = _WORDS.get(self.setting, words)
        if self.setting == "treated":
            return f"guessed: {words}"
        if self.setting in _SHARES:
            return f"guessed: {words} {100 * self.value:g} %"
        if self.setting == "speed_m_s":
            return f"guessed: {words} {3.6 * self.value:.3g} km/h"
        if self.setting == "row_bearing_deg":
            return f"guessed: row bearing {self.value:.1f} degrees, along the longest side"
        if self.setting == "hours":
            return f"guessed: {words} {self.value:g} h"
        unit = "s" if self.setting.endswith("_s") else "m"
        return f"guessed: {words} {self.value:g} {unit}"
