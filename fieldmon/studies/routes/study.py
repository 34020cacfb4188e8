"""Methods beside each other on reward matrices: reward, steps, seconds, bound, proof."""

from __future__ import annotations

import csv
import io
import time
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.planning.routes.ladder import sweep
from fieldmon.studies.routes import milp, vrp
from fieldmon.studies.routes.drive import driven
from fieldmon.studies.routes.heuristics import HEURISTICS
from fieldmon.studies.routes.instances import full_budget

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

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
    """Yield a line for each method and share of the full budget; the exact sweep serves all.

    Its seconds are those of the whole sweep and of the walk. A heuristic that is found to be
    better than the exact walk would be an error, and is raised as one.
    """
    reward = instance.reward
    full, total = full_budget(*reward.shape), float(reward.sum())
    began = time.perf_counter()
    swept = sweep(reward, int(full * max(shares)))
    sweep_s = time.perf_counter() - began
    for share in shares:
        budget = int(full * share)
        began = time.perf_counter()
        walk = swept.walk(budget)
        took_s = sweep_s + time.perf_counter() - began
        checked = driven(walk.place, reward)
        most = checked.reward
        if abs(most - walk.reward) > _SAME * max(total, 1.0) or checked.steps > budget:
            raise AssertionError("the exact walk must cost and hold what it says")
        about = instance.name, budget, share
        yield MethodOutcome(*about, EXACT, most, most / total, checked.steps, took_s, most, True)
        for method in methods:
            if method == MILP:
                if reward.size <= _MILP_PLANTS:
                    yield _by_milp(about, instance, solver_s)
                continue
            if method == PYVRP and (reward > 0).sum() > vrp.MOST_PLANTS:
                continue
            began = time.perf_counter()
            if method == PYVRP:
                place = vrp.collect(reward, budget, solver_s)
            else:
                place = HEURISTICS[method](reward, budget)
            took_s = time.perf_counter() - began
            checked = driven(place, reward)
            if checked.steps > budget or checked.reward > most + _SAME * max(total, 1.0):
                raise AssertionError(f"{method} must keep to the budget and not exceed the best")
            held = checked.reward
            yield MethodOutcome(
                *about, method, held, held / total, checked.steps, took_s, None, held >= most
            )


def _by_milp(about: tuple[str, int, float], instance: Instance, solver_s: float) -> MethodOutcome:
    began = time.perf_counter()
    found = milp.solve(instance.reward, about[1], solver_s)
    took_s = time.perf_counter() - began
    total = float(instance.reward.sum())
    of_all = found.reward / total
    return MethodOutcome(
        *about, MILP, found.reward, of_all, about[1], took_s, found.bound, found.proved
    )


def csv_text(lines: Sequence[MethodOutcome]) -> str:
    """Return the table: instance, budget, method, reward, cost, seconds, bound, proved."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        ["instance", "budget", "method", "reward", "cost", "seconds", "bound", "proved"]
    )
    for line in lines:
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


def sentences(lines: Sequence[MethodOutcome]) -> list[str]:
    """Return one line a budget and instance: shares of all reward, and the gain of the best."""
    groups: dict[tuple[str, float], list[MethodOutcome]] = {}
    for line in lines:
        groups.setdefault((line.instance, line.share), []).append(line)
    told = []
    for (name, share), group in groups.items():
        exact = next(line for line in group if line.method == EXACT)
        rest = [line for line in group if line.method != EXACT]
        shown = ", ".join(f"{line.method} {line.of_all:.1%}" for line in rest)
        told.append(
            f"{name}, {share:.0%} of the full budget: {exact.of_all:.1%} of all reward "
            f"({exact.seconds:.2f} s, proved); {shown}"
        )
    return told
