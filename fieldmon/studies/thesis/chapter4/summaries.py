"""What a table comes to, in sentences with numbers."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from fieldmon.studies.thesis.chapter4.verdicts import AGREES, DIFFERS, EQUAL, MISPRINT, NEAR
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS

if TYPE_CHECKING:
    from fieldmon.studies.thesis.chapter4.measures import NoPriorMeasure

VISITED = ("PVV_ED1", "PVV_ED2", "PVV_ED3", "visited_all")
_VERDICTS = (EQUAL, NEAR, MISPRINT, DIFFERS)


def say_verdicts(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Count the verdicts on the thesis's cells, and on the reference."""
    said = [cell for cell in cells if cell.thesis_verdict]
    sentences = []
    if said:
        ours = "most likely day" if said[0].measure.startswith("D") else "mean, as printed"
        count = {v: sum(cell.thesis_verdict == v for cell in said) for v in _VERDICTS}
        sentences.append(
            f"Of {len(said)} printed cells {count[EQUAL]} are equal to our {ours}; {count[NEAR]} "
            f"are near it, {count[MISPRINT]} are known misprints and {count[DIFFERS]} differ."
        )
        fixed = [cell for cell in said if cell.sd == 0 and cell.measure in VISITED]
        if fixed:
            exact = sum(cell.thesis_verdict == EQUAL for cell in fixed)
            sentences.append(
                f"Of the {len(fixed)} cells of faces visited in which nothing is random, {exact} "
                "are equal to the digit printed."
            )
    referred = [cell for cell in cells if cell.reference_verdict]
    if referred:
        agree = sum(cell.reference_verdict == AGREES for cell in referred)
        sentences.append(
            f"Our means agree with the reference in {agree} of {len(referred)} cells "
            "(within three standard errors of the difference)."
        )
    return tuple(sentences)


def say_pairs(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Say in how many pairs the snake finds at least as much as the neighbor strategy."""
    by_rules: dict[str, list[str]] = defaultdict(list)
    for day in (1, 2, 3):
        pairs: dict[str, list[NoPriorMeasure]] = defaultdict(list)
        for cell in cells:
            if cell.measure == f"snake - neighbor, found_day{day}":
                pairs[cell.rules].append(cell)
        for rules, group in pairs.items():
            ahead = sum(cell.mean >= 0 for cell in group)
            sure = sum(cell.high < 0 for cell in group)
            less = f" (beyond chance less in {sure})" if sure else ""
            by_rules[rules].append(f"day {day}: {ahead} of {len(group)}{less}")
    return tuple(
        f"At equal viewpoint time, {rules}, the snake has found at least as much as the neighbor "
        f"strategy in: {'; '.join(parts)}."
        for rules, parts in by_rules.items()
    )


def say_everywhere(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Say what algorithm 6 finds on day 3 under each set of rules, field by field."""
    third = [cell for cell in cells if cell.measure == "PCD_ED3"]
    sentences = []
    for field in dict.fromkeys(cell.field for cell in third):
        parts = [
            f"{cell.mean:.1f} % {cell.rules}"
            for cell in third
            if cell.field == field and cell.replicates > 1
        ]
        what = f"algorithm 6 finds {', '.join(parts)}" if parts else "there are none left to find"
        sentences.append(f"{_field(field)}: of the faces infested on the third morning {what}.")
    return tuple(sentences)


def say_trend(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Say how each strategy's detection falls from the smallest plot to the biggest."""
    lines: dict[str, list[NoPriorMeasure]] = defaultdict(list)
    for cell in cells:
        if cell.measure == "PCD_ALL":
            lines[f"algorithm {cell.algorithm} (N = {cell.n})"].append(cell)
    parts = []
    for label, line in lines.items():
        small, big = min(line, key=lambda c: c.faces), max(line, key=lambda c: c.faces)
        parts.append(f"{label} {small.mean:.0f} to {big.mean:.0f} %")
    fewest, most = min(c.faces for c in cells), max(c.faces for c in cells)
    falls = f"From {fewest} to {most} faces the share detected in three days falls"
    return (f"{falls}: {'; '.join(parts)}.",)


def say_bigger(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Say what each random strategy detects in three days, field by field."""
    found: dict[str, list[str]] = defaultdict(list)
    for cell in cells:
        if cell.measure == "PCD_ALL":
            n = f", N = {cell.n}" if cell.n != "R" else ""
            found[f"{_field(cell.field)}, {cell.faces} faces, {cell.rules}"].append(
                f"algorithm {cell.algorithm}{n} {cell.mean:.0f} %"
            )
    return tuple(
        f"{field}, detected in three days: {', '.join(parts)}." for field, parts in found.items()
    )


def say_slips(cells: list[NoPriorMeasure]) -> tuple[str, ...]:
    """Say which strategy each slip changes most, in percent detected over three days."""
    sentences = []
    for rules in dict.fromkeys(cell.rules for cell in cells):
        words = "detected in three days"
        most, label = _most_changed(cells, rules, "PCD_ALL")
        if most == 0:
            words = "what the listing says is detected"
            most, label = _most_changed(cells, rules, "curve_listed_day3")
        if rules != "as published":
            name = rules[0].upper() + rules[1:]
            sentences.append(f"{name}: {words} changes by up to {most:+.1f} points ({label}).")
    return tuple(sentences)


def _most_changed(cells: list[NoPriorMeasure], rules: str, measure: str) -> tuple[float, str]:
    """Return the greatest change against the listings as published, and the strategy it meets."""
    means: dict[str, dict[str, float]] = defaultdict(dict)
    for cell in cells:
        if cell.measure == measure:
            means[f"algorithm {cell.algorithm}, N = {cell.n}"][cell.rules] = cell.mean
    changes = [(mean[rules] - mean["as published"], label) for label, mean in means.items()]
    return max(changes, key=lambda change: abs(change[0]))


def _field(name: str) -> str:
    return f"Scenario {name}" if name in SCENARIOS else name
