"""Which configurations chapter 4 tries, table by table, and those that its conclusions need."""

from __future__ import annotations

from fieldmon.studies.thesis.chapter4.listing_errors import (
    ALL_PUT_RIGHT,
    AS_PUBLISHED,
    NAMES,
    NIGHT_CORRECTED,
    ListingErrors,
)
from fieldmon.studies.thesis.chapter4.trial import (
    TABLE_ROWS,
    NoPriorTrial,
    Prose,
    ThesisStrategy,
    table_viewpoints,
)
from fieldmon.studies.thesis.chapter4.vineyard import SCENARIOS, VIEWPOINTS_S, Vineyard

SEVERITIES = (0.1, 0.3, 0.5, 0.9)
BETWEEN_ROWS_M = 3.5
BETWEEN_PLANTS_M = 3.0
"""Ours: our source does not state the spacings of the bigger fields and of table 1. Rows 3.5 m
apart make 6 rows of scenarios A, B and C at 2, 4 and 8 dunam; vines stand 3 m apart as in B."""

BIGGER = ((200, 4), (200, 6), (210, 11))
"""Row length in m and area in dunam of the thesis's bigger fields."""

TREND_ROWS_M = (100, 200, 300, 400)
TREND_DUNAM = (2, 4, 6, 8)
"""Ours: the grid of plots of the thesis's table 1 is not in our source."""


def neighbor_every(every: int) -> ThesisStrategy:
    """Return the neighbor strategy that skips to every N-th plant."""
    return ThesisStrategy(6) if every == 1 else ThesisStrategy(4, every)


def snake_every(every: int) -> ThesisStrategy:
    """Return the snake strategy that skips to every N-th plant."""
    return ThesisStrategy(1) if every == 1 else ThesisStrategy(2, every)


def table_trials(letter: str, severity: float = 0.3) -> list[NoPriorTrial]:
    """Return the rows of a printed table."""
    return [
        NoPriorTrial(
            SCENARIOS[letter], strategy, table_viewpoints(strategy, AS_PUBLISHED), severity
        )
        for strategy in TABLE_ROWS
    ]


def bigger_trials() -> list[NoPriorTrial]:
    """Return the random strategies on bigger fields."""
    vineyards = [
        Vineyard.from_size(row_m, dunam, BETWEEN_ROWS_M, BETWEEN_PLANTS_M)
        for row_m, dunam in BIGGER
    ]
    listed = [
        NoPriorTrial(vineyard, strategy, table_viewpoints(strategy, AS_PUBLISHED))
        for vineyard in vineyards
        for strategy in (ThesisStrategy(3), ThesisStrategy(5))
    ]
    prose = (
        ThesisStrategy(3),
        ThesisStrategy(5),
        ThesisStrategy(7, 2),
        ThesisStrategy(7, 3),
        ThesisStrategy(7, 4),
    )
    return listed + [
        NoPriorTrial(vineyard, strategy, 3, rules=Prose())
        for vineyard in vineyards
        for strategy in prose
    ]


def trend_trials() -> list[NoPriorTrial]:
    """Return the rows of the tables on a grid of plots."""
    return [
        NoPriorTrial(
            Vineyard.from_size(row_m, dunam, BETWEEN_ROWS_M, BETWEEN_PLANTS_M),
            strategy,
            table_viewpoints(strategy, AS_PUBLISHED),
        )
        for row_m in TREND_ROWS_M
        for dunam in TREND_DUNAM
        for strategy in TABLE_ROWS
        if 1000 * dunam / (row_m * BETWEEN_ROWS_M) >= 2
    ]


def equal_trials() -> list[NoPriorTrial]:
    """Return snake and neighbor, one after the other, with the same viewpoints."""
    return [
        NoPriorTrial(SCENARIOS[letter], strategy, viewpoints, rules=rules)
        for rules in (AS_PUBLISHED, NIGHT_CORRECTED, Prose())
        for letter in SCENARIOS
        for viewpoints in VIEWPOINTS_S
        for every in (1, 2, 3, 4)
        for strategy in (snake_every(every), neighbor_every(every))
    ]


def everywhere_trials() -> list[NoPriorTrial]:
    """Return algorithm 6 on every field, with the night as listed, corrected and described."""
    bigger = [
        Vineyard.from_size(row_m, dunam, BETWEEN_ROWS_M, BETWEEN_PLANTS_M)
        for row_m, dunam in BIGGER
    ]
    return [
        NoPriorTrial(vineyard, ThesisStrategy(6), 1, rules=rules)
        for vineyard in dict.fromkeys((*SCENARIOS.values(), *bigger))
        for rules in (AS_PUBLISHED, NIGHT_CORRECTED, Prose())
    ]


def slip_trials() -> list[NoPriorTrial]:
    """Return the rows of table 4 with each slip put right alone."""
    variants: list[ListingErrors] = [AS_PUBLISHED, *(AS_PUBLISHED.without(name) for name in NAMES)]
    return [
        NoPriorTrial(SCENARIOS["C"], strategy, table_viewpoints(strategy, slips), rules=slips)
        for slips in (*variants, NIGHT_CORRECTED, ALL_PUT_RIGHT)
        for strategy in TABLE_ROWS
    ]
