"""Adaptive's days and nights in seasons that go badly: ``python -m tests.benchmarks.bad_seasons``.

25 days on thesis plot C and on a crooked plot of its size; then, with ``--million``, five days on a
million plants. Processor time, compiled before; the map is that of traced pairs.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.insects.spread import Spread
from fieldmon.plot.layout import lay, rectangle
from fieldmon.plot.planting import Planting
from fieldmon.plot.robot import Robot
from fieldmon.plot.travel import Aisles
from fieldmon.samplers import sampler
from fieldmon.simulation.season import SimulationSettings, simulated_days
from fieldmon.simulation.start import Start
from tests.benchmarks.test_bench_grid import crooked_plot

#: share infested on the first morning, chance of a night to spread, to whom, hours a day
SEASONS = (
    (0.02, 0.3, "one", 12.0),
    (0.02, 0.3, "one", 4.0),
    (0.10, 0.3, "one", 12.0),
    (0.02, 0.3, "each", 12.0),
    (0.30, 0.3, "one", 12.0),
    (0.05, 0.5, "each", 12.0),
)


def crooked(n_plants):
    return Aisles.of(lay(crooked_plot(n_plants), Planting(row_bearing_deg=33.0, headland_m=1.0)))


def days_s(aisles, season, n_days=25):
    """Return the seconds of each day with its night, and how many are infested on the last."""
    share, rate, to, hours = season
    n = len(aisles.grid)
    infested = RandomStreams(1).of("start").random(n) < share
    settings = SimulationSettings(n_days=n_days, spread=Spread(rate, to))
    days = simulated_days(
        aisles, Robot(hours=hours), sampler("adaptive"), Start(infested, np.full(n, share)),
        settings, RandomStreams(2),
    )  # fmt: skip
    took_s, left, since_s = [], 0, time.process_time()
    for day in days:
        left, now_s = int(day.infested.sum()), time.process_time()
        took_s.append(now_s - since_s)
        since_s = now_s
    return took_s, left


def tell(line):
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--million", action="store_true", help="Five days on a million plants.")
    million = parser.parse_args().million
    days_s(crooked(1_000), SEASONS[0], 3)
    plots = [Aisles.of(rectangle(91, 91)), crooked(8_112)]
    tell("| infested at first, a night, hours a day | plants | the longest day | 25 days | left |")
    tell("|---|---|---|---|---|")
    for season in SEASONS:
        share, rate, to, hours = season
        for aisles in plots:
            took_s, left = days_s(aisles, season)
            of = f"{share:.0%}, {rate:.0%} to {to}, {hours:g} h | {len(aisles.grid)}"
            tell(f"| {of} | {max(took_s):.2f} s | {sum(took_s):.2f} s | {left} |")
    if million:
        aisles = crooked(1_000_000)
        took_s, _ = days_s(aisles, SEASONS[0], 5)
        tell(f"{len(aisles.grid)} plants: {', '.join(f'{s:.1f}' for s in took_s)} s")


if __name__ == "__main__":
    main()
