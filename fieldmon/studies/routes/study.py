"""Methods beside each other on reward matrices: reward, steps, seconds, bound, proof."""

from __future__ import annotations

import csv
import io
import time
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.planning.routes.exact_walk import best_walk
from fieldmon.studies.routes import milp, vrp
from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.heuristics import HEURISTICS
from fieldmon.studies.routes.instances import full_budget
from fieldmon.studies.routes.team_walks import meetings, team_walks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fieldmon.studies.routes.instances import Instance

EXACT, PYVRP, MILP = "ladder", "PyVRP", "MILP"
# a proof by mixed-integer programming is asked for on small instances only
_MILP_PLANTS = 400
_SAME = 1e-9


class MethodOutcome(NamedTuple):
    """One method on one instance at one budget; `bound` is None where the method knows none."""

    instance: str
    budget: int
    share: float
    method: str
    reward: float
    of_all: float
    cost: int
    seconds: float
    bound: float | None
    proved: bool


def run(
    instance: Instance, shares: Sequence[float], methods: Sequence[str], solver_s: float = 10.0
) -> Iterator[MethodOutcome]:
    """Yield an outcome for each share of the full budget and method, the exact one first.

    A heuristic that is found to be better than the exact walk would be an error, and is raised as
    one.
    """
    # loops are loaded first: their compiling is not the walk's time
    best_walk(instance.reward[:2, :2], 8)
    for share in shares:
        exact = _by_ladder(instance, share)
        yield exact
        for method in methods:
            if method == MILP:
                if instance.reward.size <= _MILP_PLANTS:
                    yield _by_milp(exact, instance, solver_s)
            elif method != PYVRP or (instance.reward > 0).sum() <= vrp.MOST_PLANTS:
                yield _by_heuristic(exact, instance, method, solver_s)


def _by_ladder(instance: Instance, share: float) -> MethodOutcome:
    reward = instance.reward
    budget, total = int(full_budget(*reward.shape) * share), float(reward.sum())
    began = time.process_time()
    walk = best_walk(reward, budget)
    took_s = time.process_time() - began
    checked = driven(walk.place, reward)
    if abs(checked.reward - walk.reward) > _SAME * max(total, 1.0) or checked.steps > budget:
        raise AssertionError("the exact walk must cost and hold what it says")
    most = checked.reward
    held = most, _share(most, total), checked.steps, took_s
    return MethodOutcome(instance.name, budget, share, EXACT, *held, most, True)


def run_teams(
    instance: Instance,
    shares: Sequence[float],
    sizes: Sequence[int],
    tell: Callable[[float], object] | None = None,
) -> Iterator[MethodOutcome]:
    """Yield an outcome for each share of the full budget, which each has, and size of a team.

    The cost is that of the longest walk. `tell` hears which share of a team's search is done.
    """
    reward = instance.reward
    total = float(reward.sum())
    for share, size in product(shares, sizes):
        budget = int(full_budget(*reward.shape) * share)
        began = time.process_time()
        team = team_walks(reward, budget, size, tell)
        took_s = time.process_time() - began
        steps = max(driven(places, reward).steps for places in team.places)
        if steps > budget or meetings(team.places, reward.shape[1]):
            raise AssertionError("a team must keep to its budgets, and nobody meet in a row")
        about = instance.name, budget, share, f"team of {size}"
        held = team.reward, _share(team.reward, total), steps, took_s
        proved = team.bound <= team.reward * (1.0 + _SAME)
        yield MethodOutcome(*about, *held, team.bound, proved)


def team_sentences(outcomes: Sequence[MethodOutcome]) -> list[str]:
    """Return one line a team: its share of all reward, and what none can exceed."""
    return [
        f"{one.instance}, {one.method}, each {one.share:.0%} of the full budget: {one.of_all:.1%} "
        f"of all reward, at most {one.bound / one.reward - 1.0:.1%} below the best "
        f"({one.seconds:.1f} s)"
        for one in outcomes
        if one.bound is not None and one.reward > 0.0
    ]


def _by_heuristic(
    exact: MethodOutcome, instance: Instance, method: str, solver_s: float
) -> MethodOutcome:
    reward, total = instance.reward, float(instance.reward.sum())
    began = time.process_time()
    if method == PYVRP:
        place = vrp.collect(reward, exact.budget, solver_s)
    else:
        place = HEURISTICS[method](reward, exact.budget)
    took_s = time.process_time() - began
    checked = driven(place, reward)
    if checked.steps > exact.budget or checked.reward > exact.reward + _SAME * max(total, 1.0):
        raise AssertionError(f"{method} must keep to the budget and not exceed the best")
    about = exact.instance, exact.budget, exact.share, method
    held = checked.reward, _share(checked.reward, total), checked.steps, took_s
    return MethodOutcome(*about, *held, None, False)


def _by_milp(exact: MethodOutcome, instance: Instance, solver_s: float) -> MethodOutcome:
    began = time.process_time()
    found = milp.solve(instance.reward, exact.budget, solver_s)
    took_s = time.process_time() - began
    of_all = _share(found.reward, float(instance.reward.sum()))
    about = exact.instance, exact.budget, exact.share, MILP
    held = found.reward, of_all, exact.budget, took_s
    return MethodOutcome(*about, *held, found.bound, found.proved)


def _share(reward: float, total: float) -> float:
    return reward / total if total > 0.0 else 1.0


def csv_text(outcomes: Sequence[MethodOutcome]) -> str:
    """Return all outcomes: instance, budget, method, reward, cost, seconds, bound, proved."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        ["instance", "budget", "method", "reward", "cost", "seconds", "bound", "proved"]
    )
    for line in outcomes:
        bound = "" if line.bound is None else f"{line.bound:.6g}"
        writer.writerow(
            [
                line.instance,
                line.budget,
                line.method,
                f"{line.reward:.6g}",
                line.cost,
                f"{line.seconds:.3f}",
                bound,
                "yes" if line.proved and line.bound is not None else "no",
            ]
        )
    return text.getvalue()


def sentences(outcomes: Sequence[MethodOutcome]) -> list[str]:
    """Return one line a budget and instance: shares of all reward, and the exact one's seconds."""
    told = []
    for exact, rest in _groups(outcomes):
        shown = ", ".join(f"{one.method} {one.of_all:.1%}" for one in rest)
        told.append(
            f"{exact.instance}, {exact.share:.0%} of the full budget: {exact.of_all:.1%} of all "
            f"reward ({exact.seconds:.2f} s, proved); {shown}"
        )
    return told


def table(outcomes: Sequence[MethodOutcome]) -> str:
    """Return a table in Markdown: the exact walk, and by how much it exceeds each other method."""
    groups = _groups(outcomes)
    names = list(dict.fromkeys(one.method for _, rest in groups for one in rest))
    head = ["instance", "budget", "of all reward", "seconds", "more than the best", *names]
    lines = [head, ["---"] * len(head)]
    for exact, rest in groups:
        by = {one.method: one.reward for one in rest}
        gains = [_gain(exact.reward, by[name]) if name in by else "" for name in names]
        best = _gain(exact.reward, max(by.values())) if by else ""
        about = [exact.instance, f"{exact.share:.0%}", f"{exact.of_all:.1%}"]
        lines.append([*about, f"{exact.seconds:.2f}", best, *gains])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _gain(exact: float, other: float) -> str:
    return f"{exact / other - 1.0:.1%}" if other > 0.0 else ""


def _groups(
    outcomes: Sequence[MethodOutcome],
) -> list[tuple[MethodOutcome, list[MethodOutcome]]]:
    """Return the exact outcome of each instance and budget with those of all other methods."""
    by: dict[tuple[str, float], list[MethodOutcome]] = {}
    for one in outcomes:
        by.setdefault((one.instance, one.share), []).append(one)
    return [(group[0], group[1:]) for group in by.values()]
