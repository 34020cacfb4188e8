"""Spread beside pops-core's: ``python -m tests.benchmarks.against_pops PROGRAM``.

PROGRAM is a harness of one's own around the functions ``generate`` and ``disperse`` of its
Simulation, which is in C++. It takes side, hosts a cell, days, rate a day, mean jump, size of a
cell, share infested at first and repetitions, and prints its best seconds and the mean number
infested in the end. None of its code is here. Ours counts what lands at its centre too, as it does.
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.dispersal import Dispersal
from fieldmon.infestation.insects.kernels import DistanceKernel
from tests.benchmarks.scale import best_of, told

SIDE, DAYS, MEAN_M, CELL_M = 91, 25, 6.0, 3.0
TIMES = 20
#: hosts a cell, rate a day, share infested at first
CASES = ((1, 0.1, 0.02), (1, 0.5, 0.1), (20, 0.5, 0.1), (20, 2.0, 0.1))


def cells_of(hosts):
    of_plant = np.repeat(np.arange(SIDE * SIDE), hosts)
    start = np.arange(SIDE * SIDE + 1) * hosts
    shape, size_m = np.array([SIDE, SIDE]), np.array([CELL_M, CELL_M])
    return Cells(of_plant, start, np.arange(len(of_plant)), shape, size_m)


def ours(hosts, rate, share):
    """Return our best seconds, and how many are infested in the end on average."""
    cells = cells_of(hosts)
    kernel = DistanceKernel("exponential", MEAN_M).on_cells(cells.size_m, (12, 12), own=True)
    dispersal = Dispersal(cells, kernel)
    ended, starts = [], []
    for seed in range(TIMES):
        draws = RandomStreams(seed).of("start").random(len(cells.of_plant))
        starts.append(draws < share)

    def season():
        seed = len(ended) % TIMES
        streams, infested = RandomStreams(seed), starts[seed].copy()
        for day, key in zip(range(DAYS), streams.keys("spread"), strict=False):
            infested |= dispersal.reached(np.flatnonzero(infested), rate, key, day)
        ended.append(int(infested.sum()))

    seconds, _ = best_of(season, TIMES)
    return seconds, float(np.mean(ended))


def theirs(program, hosts, rate, share):
    """Return what the harness says."""
    numbers = (SIDE, hosts, DAYS, rate, MEAN_M, CELL_M, share, TIMES)
    command = [program, *(str(number) for number in numbers)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    seconds, ended = (float(word) for word in done.stdout.split())
    return seconds, ended


def main():
    for case in CASES:
        hosts, rate, share = case
        (seconds, ended), (other, their_end) = ours(*case), theirs(sys.argv[1], *case)
        sys.stdout.write(
            f"{SIDE} x {SIDE}, {hosts} hosts a cell, {rate} a day, {share:.0%} infested at first, "
            f"{DAYS} days: {told(seconds)}, {ended:.0f} in the end; pops-core {told(other)}, "
            f"{their_end:.0f}: ours takes {seconds / other:.2f} of its time\n"
        )


if __name__ == "__main__":
    main()
