"""Which open choices come nearest to the published figures, and which figures conflict."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread
from fieldmon.studies.thesis.chapter5.fitted_choices import CALIBRATED
from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices, StartUp
from fieldmon.studies.thesis.chapter5.published import FIGURES, PARTS
from fieldmon.studies.thesis.chapter5.replicates import run_trials, seed_keys
from fieldmon.studies.thesis.chapter5.verdicts import misfit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    import numpy as np

    from fieldmon.simulation.experiment import Progress

SPACE: dict[str, tuple[Any, ...]] = {
    "share": (0.002, 0.003, 0.005, 0.008, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3),
    "margin_share": (0.0, 0.5, 0.8, 1.0),
    "depth_m": (2.0, 5.0, 10.0, 30.0),
    "cluster_size": (1.0, 2.0, 4.0, 10.0, 30.0),
    "recorded_share": (0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0),
    "rate_per_day": (0.3, 0.5, 0.8),
    "to": ("each", "one", "all"),
    "sources": ("left", "missed"),
    "missed_known": (False, True),
    "map_follows": (False, True),
    "bouncy_rests": (False, True),
    "counts": ("infestations", "plants"),
    "ends": ("season", "find"),
    "stop_s": (0.0, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0),
    "row_change_s": (25.0, 100.0, 200.0, 300.0, 450.0, 600.0, 900.0),
}
"""The values tried for each open choice."""

_START = ("share", "margin_share", "depth_m", "cluster_size", "recorded_share")
_SPREAD = ("rate_per_day", "to")
_APART = 0.5


@dataclass(frozen=True)
class Effort:
    """How long to search: candidates and seeds, stage by stage.

    Parameters
    ----------
    drawn, drawn_seeds
        Candidates drawn evenly from `SPACE`, tried on scenarios A to C.
    kept, kept_seeds
        How many of them (best jointly, and best for each part) go on to all parts.
    steps
        Rounds in which a choice or two of the best are changed.
    finalists, final_seeds
        How many go into the final comparison, and its seeds.
    """

    drawn: int = 500
    drawn_seeds: int = 2
    kept: int = 20
    kept_seeds: int = 4
    steps: int = 400
    finalists: int = 15
    final_seeds: int = 20


@dataclass(frozen=True)
class TriedChoices:
    """Open choices and how far off each part is under them, in steps (see `verdicts.misfit`)."""

    choices: OpenChoices
    parts: tuple[tuple[str, float], ...]

    @property
    def off(self) -> dict[str, float]:
        """Steps off by part."""
        return dict(self.parts)

    @property
    def joint(self) -> float:
        """Mean over the parts."""
        return sum(value for _, value in self.parts) / len(self.parts)


@dataclass(frozen=True)
class FittedChoices:
    """What a search found.

    Parameters
    ----------
    best
        The best joint fit.
    per_part
        The best fit of each part alone.
    conflicts
        Pairs of parts that pull apart: how far off the worse of the two is where it is met best
        alone, and where both are met best together, if that is half a step more or worse. Over
        everything that was tried on all parts.
    tried
        The finalists, best first.
    """

    best: TriedChoices
    per_part: dict[str, TriedChoices]
    conflicts: tuple[tuple[str, str, float, float], ...]
    tried: tuple[TriedChoices, ...]
    stopped: bool = False


def choices_of(values: dict[str, Any]) -> OpenChoices:
    """Return open choices from a value of each name of `SPACE`."""
    rest = {name: values[name] for name in values if name not in (*_START, *_SPREAD)}
    return OpenChoices(
        start=StartUp(**{name: values[name] for name in _START}),
        spread=Spread(**{name: values[name] for name in _SPREAD}),
        **rest,
    )


def values_of(choices: OpenChoices) -> dict[str, Any]:
    """Return the value of each name of `SPACE`."""
    groups = (choices.start, choices.spread, choices)
    return {
        name: next(getattr(group, name) for group in groups if hasattr(group, name))
        for name in SPACE
    }


def calibrate(
    effort: Effort | None = None, seed: int = 1, progress: Progress | None = None
) -> FittedChoices:
    """Search the open choices; Ctrl-C ends the search and keeps what was tried on all parts.

    Drawn evenly, the best are tried on all parts, then one choice after the other is changed in
    the best joint fit and in the best fit of each part; the front-runners meet more seeds.
    """
    effort = effort or Effort()
    search = _ChoiceSearch(effort, seed, progress)
    try:
        search.run()
    except KeyboardInterrupt:
        if not search.all_parts:
            raise
        return _fitted(search.all_parts, search.all_parts, stopped=True)
    return _fitted(search.final, search.all_parts, stopped=False)


class _ChoiceSearch:
    """The state of a search, so that it can be left at any time."""

    def __init__(self, effort: Effort, seed: int, progress: Progress | None) -> None:
        self.effort, self.seed, self.progress = effort, seed, progress
        self.rng = RandomStreams(seed).of("calibrate")
        self.all_parts: list[TriedChoices] = []
        self.final: list[TriedChoices] = []
        self.done = 0
        self.total = effort.drawn + 1 + effort.kept + effort.steps + effort.finalists

    def run(self) -> None:
        effort = self.effort
        drawn = [
            self._try(_drawn(self.rng), ("A", "B", "C"), effort.drawn_seeds)
            for _ in range(effort.drawn)
        ]
        # the present defaults take part, so that a search goes on where the last one ended
        for choices in dict.fromkeys([CALIBRATED, *_front(drawn, effort.kept)]):
            self.all_parts.append(self._try(choices, PARTS, effort.kept_seeds))
        for step in range(effort.steps):
            # in turn: the joint fit twice, then each part alone
            part = (None, None, *PARTS)[step % (len(PARTS) + 2)]
            best = min(self.all_parts, key=_key(part))
            changed = _changed(best.choices, self.rng)
            if all(changed != each.choices for each in self.all_parts):
                self.all_parts.append(self._try(changed, PARTS, effort.kept_seeds))
        for choices in _front(self.all_parts, effort.finalists):
            self.final.append(self._try(choices, PARTS, effort.final_seeds))

    def _try(self, choices: OpenChoices, parts: Sequence[str], seeds: int) -> TriedChoices:
        cases = {
            case for figure in FIGURES if figure.fitted and figure.part in parts
            for case in figure.cases
        }  # fmt: skip
        made = run_trials([case.trial(choices) for case in cases], seed_keys(seeds, self.seed))
        if made.stopped:
            raise KeyboardInterrupt
        off = misfit(made.runs, choices)
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, self.total)
        return TriedChoices(choices, tuple((part, off[part]) for part in parts))


def _drawn(rng: np.random.Generator) -> OpenChoices:
    return choices_of({name: each[rng.integers(len(each))] for name, each in SPACE.items()})


def _changed(choices: OpenChoices, rng: np.random.Generator) -> OpenChoices:
    """Return choices with one or two of them drawn again."""
    values = values_of(choices)
    for name in rng.choice(list(SPACE), size=rng.integers(1, 3), replace=False):
        values[name] = SPACE[name][rng.integers(len(SPACE[name]))]
    return choices_of(values)


def _key(part: str | None) -> Callable[[TriedChoices], float]:
    return (lambda each: each.joint) if part is None else (lambda each: each.off[part])


def _front(tried: Iterable[TriedChoices], n: int) -> list[OpenChoices]:
    """Return the best jointly (half) and the best for each part, `n` at most."""
    tried = list(tried)
    parts = tuple(tried[0].off)
    best = [each.choices for each in sorted(tried, key=_key(None))]
    rounds = max(1, n // (2 * len(parts)))
    alone = [each.choices for part in parts for each in sorted(tried, key=_key(part))[:rounds]]
    return list(dict.fromkeys([*best[: n - len(alone)], *alone, *best]))[:n]


def _fitted(
    finalists: list[TriedChoices], tried: list[TriedChoices], *, stopped: bool
) -> FittedChoices:
    ranked = tuple(sorted(finalists, key=_key(None)))
    per_part = {part: min(ranked, key=_key(part)) for part in PARTS}
    return FittedChoices(ranked[0], per_part, _conflicts(tried), ranked, stopped)


def _conflicts(tried: list[TriedChoices]) -> tuple[tuple[str, str, float, float], ...]:
    best = {part: min(each.off[part] for each in tried) for part in PARTS}
    pairs = []
    for one, other in combinations(PARTS, 2):
        alone = max(best[one], best[other])
        both = min(max(each.off[one], each.off[other]) for each in tried)
        if both - alone >= _APART:
            pairs.append((one, other, alone, both))
    return tuple(sorted(pairs, key=lambda pair: pair[2] - pair[3]))


def candidates_csv(tried: Sequence[TriedChoices]) -> str:
    """Return what was tried on all parts as CSV, best first: steps off, then the choices."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["joint", *PARTS, *SPACE])
    for each in tried:
        off = [f"{each.off[part]:.4g}" for part in PARTS]
        writer.writerow([f"{each.joint:.4g}", *off, *values_of(each.choices).values()])
    return text.getvalue()
