"""Best routes and their bounds on real plots: ``python -m tests.benchmarks.real_routes``.

Every plot of 200 to 40 000 plants of the parcels beside the repository, with the default spacings;
likely plants few and far between, or in four wide patches; a robot of 6 hours with the thesis's
times and a scout. ``--only Kupp`` takes the plots of one name.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
import warnings

import numpy as np

import fieldmon as fm
from fieldmon.errors import FieldmonError
from fieldmon.io.plot_request import PlantingChoices
from fieldmon.io.prepare import lay
from fieldmon.planning.routes.best_route import best
from fieldmon.plot.robot import ROBOT_TIMES, Robot, scout
from tests.paths import SHARED

LEAST, MOST = 200, 40_000
COLUMNS = ("plot", "name", "plants", "rows", "likely", "who")
COLUMNS = (*COLUMNS, "reward", "bound", "gap", "seconds", "how")
FILES = "parcels_orchards_vineyards/*.gpkg", "parcels_rlp_vineyards/vineyards.geojson"


def plots(only):
    """Yield the plots, and the number of each among all outlines, by which rewards are drawn."""
    number = -1
    for files in FILES:
        for file in sorted((SHARED / "data").glob(files)):
            for outline in fm.read_plots(file):
                number += 1
                if only and only not in outline.name:
                    continue
                try:
                    plot = lay(outline, PlantingChoices()).plot
                except FieldmonError:
                    continue
                if LEAST <= len(plot.grid) <= MOST:
                    yield number, plot


def few(grid, rng):
    """Few likely plants."""
    return rng.beta(0.05, 5, len(grid))


def patches(grid, rng):
    """Four wide patches."""
    xy_m = grid.xy_m
    middle_m = xy_m[rng.integers(0, len(grid), 4)]
    nearest = ((xy_m[:, None] - middle_m) ** 2).sum(axis=2).min(axis=1)
    return 0.3 * np.exp(-nearest / 2 / (np.ptp(xy_m, axis=0).max() / 12) ** 2) + 0.001


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", default="")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--output", default="real_routes.csv")
    told = options.parse_args()
    warnings.simplefilter("ignore")
    thesis = ROBOT_TIMES["thesis"]._asdict()
    gaps, seconds = [], []
    with open(told.output, "w", newline="", encoding="utf-8") as file:  # noqa: PTH123
        table = csv.writer(file)
        table.writerow(COLUMNS)
        for number, plot in plots(told.only):
            for likely in (few, patches):
                for who, robot in (("robot", Robot(hours=6, **thesis)), ("scout", scout())):
                    rng = np.random.default_rng((told.seed, number))
                    reward = likely(plot.grid, rng)
                    began = time.process_time()
                    route = best(plot, reward, robot)
                    took_s = time.process_time() - began
                    about = number, plot.field.name, len(plot.grid), plot.grid.n_rows
                    found = route.reward, route.bound, route.gap, took_s
                    figures = [f"{value:.5g}" for value in found]
                    table.writerow([*about, likely.__name__, who, *figures, route.how])
                    file.flush()
                    gaps.append(route.gap)
                    seconds.append(took_s)
    gap, took_s = np.array(gaps), np.array(seconds)
    sys.stdout.write(
        f"{len(gap)} routes: median {np.median(gap):.2%}, widest {gap.max():.2%}, above 3 %: "
        f"{(gap > 0.03).sum()}, above 8 %: {(gap > 0.08).sum()}; seconds of the processor: median "
        f"{np.median(took_s):.2f}, most {took_s.max():.1f}\n"
    )


if __name__ == "__main__":
    main()
