"""Samplers on mapped plots: finds per inspection and per hour, after 5, 10, 20 and 40 %."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.errors import FileProblem
from fieldmon.infestation.belief import Learning
from fieldmon.infestation.pairs.pairs import PairApproximation
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.planning.workday import work_day
from fieldmon.plot.robot import Robot
from fieldmon.samplers.adaptive import Adaptive
from fieldmon.samplers.base import NEVER, Scene
from fieldmon.samplers.dynamic import Dynamic
from fieldmon.samplers.sweeps import Naive
from fieldmon.studies.plant_maps import read_plant_maps

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.plot.grid import PlantGrid
    from fieldmon.plot.travel import Aisles
    from fieldmon.samplers.base import Sampler
    from fieldmon.studies.plant_maps import PlantMap
    from fieldmon.studies.samplers.contenders import Added

    Believe = Callable[[PlantGrid, NDArray[np.float64]], Belief]

SHARES = (0.05, 0.10, 0.20, 0.40)
# what is believed before the first inspection, of every map (our choice; nothing is known of it)
_FLAT = 0.1
# a day lasts for a twentieth of the plants, with some time to drive
_DAY, _DRIVING = 0.05, 1.3
_HOUR_S = 3600.0
#: who takes part; the last is what random inspections are expected to find
WHO = ("adaptive", "dynamic", "tuned", "naive", "random")
# less than a twentieth more or less is even
_EVEN = (0.95, 1.05)
# of fewer plants a twentieth is none
_FEWEST = 20


#: the public maps that are inspected, see `plant_maps.PUBLIC_MAPS`
FILES = (
    "citrus_ctv_IVI3and4.csv",
    "hop_viruses_HpLV.csv",
    "gumpertz.pepper.txt",
    "beall.webworms.txt",
)


class DatedMap(NamedTuple):
    """A mapped plot on one date.

    Parameters
    ----------
    name
        What it is called.
    aisles
        The plants whose state is known.
    infested
        ``(n,)`` who of them is infested.
    whole
        The map of which this is one date, and ``(plants,)`` whose state is known there; None: of
        all.
    """

    name: str
    aisles: Aisles
    infested: NDArray[np.bool_]
    whole: tuple[PlantMap, NDArray[np.bool_]] | None = None

    @property
    def unknown(self) -> int:
        """Return of how many plants nobody knows the state: they are left out."""
        return 0 if self.whole is None else int(np.count_nonzero(~self.whole[1]))


def plots_in(folder: Path) -> list[DatedMap]:
    """Return the plots that a folder has maps of, one for each date; `FileProblem` if none."""
    made = [
        _on_date(each, k) for each in read_plant_maps(folder, FILES) for k in range(len(each.dates))
    ]
    small = next((each for each in made if len(each.infested) < _FEWEST), None)
    if small is not None:
        raise FileProblem(
            f"A map must have {_FEWEST} plants or more of known state, of which the first "
            f"{SHARES[0]:.0%} are inspected, but {small.name} has {len(small.infested)}."
        )
    return made


def _on_date(each: PlantMap, date: int) -> DatedMap:
    """Return a map on one of its dates, without the plants whose state is unknown."""
    name, known, infested = each.name_on(each.dates[date]), each.known[date], each.infested[date]
    if known.all() or np.count_nonzero(known) < _FEWEST:
        return DatedMap(name, each.aisles(), infested if known.all() else infested[known])
    return DatedMap(name, each.aisles(known), infested[known], (each, known))


def found_at(
    plot: DatedMap, sampler: Sampler, believe: Believe = PairApproximation.of
) -> tuple[list[float], list[float]]:
    """Return infested plants found, and hours worked, when each of `SHARES` was inspected.

    No plant is inspected twice, every infested one inspected is found, and none infects another.
    Of a sampler that stops before, both are NaN from there on; `SettingError` if it names no plant.
    """
    n = len(plot.infested)
    robot = Robot(detection=1.0, returns=False).with_times("thesis")
    belief = believe(plot.aisles.grid, np.full(n, _FLAT))
    seen = np.zeros(n, np.bool_)
    order, done_s = np.empty(0, np.int32), np.empty(0)
    while len(order) < SHARES[-1] * n:
        scene = Scene(
            plot.aisles,
            robot,
            belief.chance,
            np.where(seen, 0, NEVER).astype(np.int32),
            at=int(order[-1]) if len(order) else -1,
            seconds_left=max(_DAY * n, 2.0) * robot.visit_s * _DRIVING,
            trail=order,
            pair_chance=belief.pair_chance,
            traces=belief.traces,
        )
        work = work_day(scene, sampler, plot.infested)
        if not len(work):
            break
        before_s = done_s[-1] if len(done_s) else 0.0
        done_s = np.concatenate([done_s, before_s + work.arrive_s + work.stop_s])
        order = np.concatenate([order, work.plant])
        seen[work.plant] = True
        belief = belief.learn(work.plant, work.found, Learning(detection=1.0))
    finds = np.cumsum(plot.infested[order])
    asked = [round(share * n) for share in SHARES]
    reached = [k - 1 for k in asked if k <= len(order)]
    never = [float("nan")] * (len(asked) - len(reached))
    found = [float(finds[k]) for k in reached]
    return found + never, [float(done_s[k]) / _HOUR_S for k in reached] + never


def correlation(plot: DatedMap) -> float:
    """Return how much alike neighbours are: the correlation of the two of every pair.

    NaN where all plants are alike, or none stands beside another.
    """
    start, other = plot.aisles.grid.adjacent
    state = plot.infested - plot.infested.mean()
    if not len(other) or plot.infested.all() or not plot.infested.any():
        return float("nan")
    alike = float((np.repeat(state, np.diff(start)) * state[other]).mean())
    return alike / float(state.var())


class MapRow(NamedTuple):
    """What a sampler came to on a map: means over the four corners from which work can begin.

    Parameters
    ----------
    name, correlation
        The map, and how much alike its neighbours are.
    who
        The sampler.
    per_inspection, per_hour
        ``(4,)`` finds at `SHARES`, NaN where it stopped before; of random inspections the share
        expected, and no hours.
    """

    name: str
    correlation: float
    who: str
    per_inspection: list[float]
    per_hour: list[float]


def table(plots: list[DatedMap], added: Sequence[Added] = ()) -> list[MapRow]:
    """Return what each sampler finds on each map, with the belief that suits it best."""
    samplers: dict[str, tuple[Callable[[], Sampler], Believe]] = {
        "adaptive": (Adaptive, TracedPairs.of),
        "dynamic": (Dynamic, PairApproximation.of),
        "tuned": (lambda: Dynamic(suspicious=0.06), PairApproximation.of),
        "naive": (Naive, PairApproximation.of),
        **{one.label: (one.make, TracedPairs.of) for one in added},
    }
    rows = []
    for each in plots:
        alike = correlation(each)
        inspected = [round(share * len(each.infested)) for share in SHARES]
        for who, (make, believe) in samplers.items():
            made = [found_at(turned, make(), believe) for turned in _turned(each)]
            finds, hours = (np.mean(values, axis=0) for values in zip(*made, strict=True))
            per_inspection = [float(f / k) for f, k in zip(finds, inspected, strict=True)]
            rows.append(MapRow(each.name, alike, who, per_inspection, (finds / hours).tolist()))
        expected = [float(each.infested.mean())] * len(SHARES)
        rows.append(MapRow(each.name, alike, "random", expected, []))
    return rows


def sentences(rows: Sequence[MapRow]) -> list[str]:
    """Return what Adaptive finds per hour in proportion to each other, whichever way it falls.

    The rows are those of a `table`: on each map every sampler once, in one order.
    """
    of: dict[str, list[MapRow]] = {}
    for row in rows:
        of.setdefault(row.who, []).append(row)
    others = {"naive": "a sweep (naive)", "dynamic": "dynamic", "tuned": "tuned"}
    others |= {who: who for who in of if who not in WHO}
    said = []
    for who, called in others.items():
        if who in of:
            said += [_ratio_sentence(of["adaptive"], of[who], called), *_stops_early(of[who])]
    return said


def _ratio_sentence(adaptive: list[MapRow], other: list[MapRow], called: str) -> str:
    """Return what Adaptive finds per hour, over what one other does, each on the same maps."""
    pairs = [(ours, theirs.per_hour[-1]) for ours, theirs in zip(adaptive, other, strict=True)]
    ratios = [(ours.per_hour[-1] / theirs, ours.name) for ours, theirs in pairs if theirs > 0.0]
    after, maps = f"After {SHARES[-1]:.0%} of the plants", _maps(len(pairs))
    none = len(pairs) - len(ratios)
    reasons = [
        *(["finds nothing there"] if any(theirs == 0.0 for _, theirs in pairs) else []),
        *(["stopped before"] if any(np.isnan(theirs) for _, theirs in pairs) else []),
    ]
    without = f"{called} {' or '.join(reasons)}"
    if not ratios:
        return f"{after} no ratio to {called} can be given on any of {maps}: {without}."
    (low, where), (high, there) = min(ratios), max(ratios)
    span = f"{low:.2f} ({where})" + (f" to {high:.2f} ({there})" if len(ratios) > 1 else "")
    fewer = sum(value < _EVEN[0] for value, _ in ratios)
    more = sum(value > _EVEN[1] for value, _ in ratios)
    return (
        f"{after} adaptive finds {span} of the finds per hour of {called}: over {_EVEN[1]:.2f} on "
        f"{more} of {maps}, under {_EVEN[0]:.2f} on {fewer}"
        + (f"; no ratio can be given on {none}: {without}." if none else ".")
    )


def _stops_early(rows: list[MapRow]) -> list[str]:
    """Return on how many maps a sampler did not come so far, if there are any."""
    early = sum(np.isnan(row.per_inspection[-1]) for row in rows)
    said = (
        f"{rows[0].who} stopped before {SHARES[-1]:.0%} of the plants on {early} of "
        f"{_maps(len(rows))}: its figures are empty where it did not come so far."
    )
    return [said] if early else []


def _maps(n: int) -> str:
    return f"{n} map{'s' * (n != 1)}"


def table_csv(rows: list[MapRow]) -> str:
    """Return such a table as CSV."""
    columns = [
        f"finds_per_{what}_at_{share:.0%}" for what in ("inspection", "hour") for share in SHARES
    ]
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    head = ["map", "neighbour_correlation", "sampler", *columns]
    lines.writerow([column.replace("%", "_pct") for column in head])
    for row in rows:
        values = [*row.per_inspection, *(row.per_hour or [np.nan] * len(SHARES))]
        cells = ["" if np.isnan(value) else f"{value:.4f}" for value in values]
        alike = "" if np.isnan(row.correlation) else f"{row.correlation:.3f}"
        lines.writerow([row.name, alike, row.who, *cells])
    return text.getvalue()


def _turned(each: DatedMap) -> list[DatedMap]:
    """Return a plot and its three mirror images: the gate at another corner each."""
    if each.whole is None:
        infested = _mirrored(each.infested, each.aisles.grid.n_rows)
        return [each._replace(infested=image) for image in infested]
    whole, known = each.whole
    states = np.zeros(len(known), np.bool_)
    states[known] = each.infested
    return [
        DatedMap(each.name, whole.aisles(stand), image[stand])
        for image, stand in zip(
            _mirrored(states, whole.n_rows), _mirrored(known, whole.n_rows), strict=True
        )
    ]


def _mirrored(plants: NDArray[np.bool_], n_rows: int) -> list[NDArray[np.bool_]]:
    rows = plants.reshape(n_rows, -1)
    return [np.ravel(image) for image in (rows, rows[::-1], rows[:, ::-1], rows[::-1, ::-1])]
