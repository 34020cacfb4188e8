"""Spread beside PoPS: the matrices that its own tests expect, from the same numbers.

PoPS (Jones et al. 2021, Frontiers in Ecology and the Environment 19:411) counts hosts in cells;
here each host is a plant, and plants of a cell share what lands on it. So its cell of N hosts, of
which a disperser finds a susceptible one with S / N, is ours of N plants. Figures are those of the
public tests of pops-core: exact where its kernels are deterministic, else means over many draws.
"""

import numpy as np
import pytest

from fieldmon.compute.random_streams import RandomStreams
from fieldmon.infestation.cells import Cells
from fieldmon.infestation.insects.colonies import Colonies
from fieldmon.infestation.insects.dispersal import Dispersal, settle
from fieldmon.infestation.insects.kernels import DistanceKernel
from fieldmon.infestation.insects.pest_in_weather import Spell
from fieldmon.pests.pest import Pest
from fieldmon.plot.layout import rectangle

SIZE_M = np.array([30.0, 30.0])
EAST = np.array([[0.0, 0.0, 1.0]])
RUNS = 300
DAY = Spell(1.0, (), 0.0)


def hosts(counts):
    """Return cells with so many plants each."""
    counts = np.asarray(counts)
    start = np.concatenate([[0], np.cumsum(counts.ravel())])
    of_plant = np.repeat(np.arange(counts.size), counts.ravel())
    return Cells(of_plant, start, np.arange(start[-1]), np.array(counts.shape), SIZE_M)


def some(cells, counts):
    """Return the first so many plants of each cell, ``(n,)``."""
    within = np.arange(len(cells.of_plant)) - cells.start[cells.of_plant]
    return within < np.asarray(counts).ravel()[cells.of_plant]


def counted(cells, plants):
    return cells.summed(plants.astype(float)).astype(int)


def dealt(shares, n):
    """Deal n jumps to the cells of a kernel, one by one to that which lacks most of its share."""
    left, jumps = shares.copy(), np.zeros(shares.shape, int)
    for _ in range(n):
        at = np.unravel_index(np.argmax(left), left.shape)
        jumps[at] += 1
        left[at] -= 1.0 / n
    return jumps


def spread_exactly(infected, kernel, rate):
    """Let cells send `rate` a host, dealt by a kernel; all settle. What leaves is counted."""
    after, a, outside = infected.copy(), kernel.shape[0] // 2, 0
    b = kernel.shape[1] // 2
    for y, x in np.argwhere(infected):
        for (v, u), n in np.ndenumerate(dealt(kernel, rate * infected[y, x])):
            to = y + v - a, x + u - b
            if all(0 <= place < side for place, side in zip(to, after.shape, strict=True)):
                after[to] += n
            else:
                outside += n
    return after, outside


@pytest.mark.parametrize(("shape", "scale_m"), [("cauchy", 0.9), ("exponential", 1.0)])
def test_deterministic_kernels_give_the_published_matrix(shape, scale_m):
    infected = np.array([[5, 0, 0], [0, 5, 0], [0, 0, 2]])
    shares = DistanceKernel(shape, scale_m).on_cells(SIZE_M, (1, 1), own=True)
    after, outside = spread_exactly(infected, shares, 2)
    # the susceptible hosts of the last cell are used up by two of its four
    hosts = infected + np.array([[10, 20, 9], [14, 15, 0], [3, 0, 2]])
    after = np.minimum(after, hosts)
    assert after.tolist() == [[15, 0, 0], [0, 15, 0], [0, 0, 4]]
    assert outside == 0


def test_the_neighbour_kernel_sends_all_to_the_cell_beside():
    cells = hosts([[100_015, 100_006], [100_014, 100_015]])
    infected = some(cells, [[5, 0], [0, 0]])
    landed = Dispersal(cells, EAST).landed(2.0 * infected)
    assert cells.summed(landed) == pytest.approx(np.array([[0.0, 10.0], [0.0, 0.0]]))


def test_the_neighbour_kernel_settles_on_average_as_published():
    cells = hosts([[2015, 2006], [2014, 2015]])
    infected = some(cells, [[5, 0], [0, 0]])
    landed = Dispersal(cells, EAST).landed(2.0 * infected)
    made = np.array(
        [counted(cells, settle(infected, landed, RandomStreams(k).key("spread")))
         for k in range(RUNS)]
    )  # fmt: skip
    error = made.std(axis=0, ddof=1) / np.sqrt(RUNS)
    assert (np.abs(made.mean(axis=0) - [[5, 10], [0, 0]]) <= 3.0 * error).all()


def begun(cells, infected, **pest):
    grid = rectangle(1, len(cells.of_plant))
    return Colonies.grown(grid, Pest("host", **pest), infected)


def test_exposed_hosts_become_infectious_after_the_published_latency():
    """Latency of three steps: ten exposed each step, infected from the fourth on."""
    cells = hosts([[1015, 1006], [1014, 1015]])
    infected = some(cells, [[5, 0], [0, 0]])
    landed = Dispersal(cells, EAST).landed(2.0 * infected)
    spreads, exposes = [], []
    for seed in range(60):
        colonies = begun(cells, infected, latency_days=3.0)
        for step in range(4):
            key = RandomStreams(seed).key("spread", step)
            colonies = colonies.older(DAY).settled(landed, key)
            exposed = colonies.infested & ~colonies.mobile
            if step == 2:
                assert counted(cells, colonies.mobile).tolist() == [[5, 0], [0, 0]]
                exposes.append(counted(cells, exposed))
        spreads.append(counted(cells, colonies.mobile))
    for runs, expected in ((exposes, [[0, 30], [0, 0]]), (spreads, [[5, 10], [0, 0]])):
        made = np.array(runs)
        error = made.std(axis=0, ddof=1) / np.sqrt(len(made))
        # hosts infected already are found again: less than one in sixty
        assert (np.abs(made.mean(axis=0) - expected) <= 3.0 * error + 0.5).all()


def test_a_latency_of_nought_is_no_latency():
    """SEI with latency 0 is SI, host for host."""
    cells = hosts([[115, 106], [114, 115]])
    infected = some(cells, [[5, 0], [0, 0]])
    one, other = begun(cells, infected), begun(cells, infected, latency_days=0.0)
    for step in range(10):
        key = RandomStreams(42).key("spread", step)
        landed = Dispersal(cells, EAST).landed(2.0 * one.mobile)
        one = one.older(DAY).settled(landed, key)
        landed = Dispersal(cells, EAST).landed(2.0 * other.mobile)
        other = other.older(DAY).settled(landed, key)
        assert (one.infested == other.infested).all()
        assert (one.mobile == other.mobile).all()


SUSCEPTIBLE, INFECTED = np.array([[10, 6], [20, 42]]), np.array([[1, 4], [16, 40]])
WORKS = np.array([[1.0, 0.5], [0.75, 0.0]])


def treated(works, protects_days, seed):
    cells = hosts(SUSCEPTIBLE + INFECTED)
    before = begun(cells, some(cells, INFECTED))
    key = RandomStreams(seed).key("treat")
    return cells, before.treated(works.ravel()[cells.of_plant], key, protects_days)


def within_3_errors(made, expected):
    made = np.array(made)
    error = made.std(axis=0, ddof=1) / np.sqrt(len(made))
    return (np.abs(made.mean(axis=0) - expected) <= 3.0 * error + 1e-12).all()


def test_a_pesticide_leaves_and_protects_the_published_numbers():
    """Ratio 1, 0.5, 0.75, 0 for seven days: infected, susceptible and resistant hosts."""
    infected, resistant, susceptible = [], [], []
    for seed in range(RUNS):
        cells, after = treated(WORKS, 7.0, seed)
        free = after.protected_days > 0.0
        infected.append(counted(cells, after.infested))
        resistant.append(counted(cells, free))
        susceptible.append(counted(cells, ~free & ~after.infested))
    assert within_3_errors(infected, [[0, 2], [4, 40]])
    assert within_3_errors(resistant, [[11, 5], [27, 0]])
    assert within_3_errors(susceptible, [[0, 3], [5, 42]])


def test_what_is_protected_is_free_again_after_the_published_week():
    cells, after = treated(np.array([[1.0, 1.0], [0.0, 0.0]]), 7.0, 1)
    assert counted(cells, after.infested).tolist() == [[0, 0], [16, 40]]
    assert counted(cells, after.protected_days > 0.0).tolist() == [[11, 10], [0, 0]]
    landed = np.full(len(cells.of_plant), 50.0)
    for day in range(7):
        after = after.older(DAY)
        assert (after.protected_days > 0.0).any() == (day < 6)
    assert counted(cells, after.settled(landed, np.uint64(1)).infested).tolist() == [
        [11, 10],
        [36, 82],
    ]


def test_all_infected_of_a_cell_can_be_removed_as_published():
    """Where any is treated all infected go; the ratio is for the susceptible alone."""
    cells, after = treated((WORKS > 0.0).astype(float), 0.0, 1)
    assert counted(cells, after.infested).tolist() == [[0, 0], [0, 40]]


def test_hosts_die_by_cohorts_as_published():
    """Rate 0.5: all three of the oldest cohort die, and one of the two after it."""
    cells = hosts([[5]])
    by_cohort = np.array([1.0, 1.0, 1.0, 0.5, 0.5])
    died = [
        5 - begun(cells, np.ones(5, bool)).treated(by_cohort, RandomStreams(k).key("die"))
        .infested.sum() for k in range(RUNS)
    ]  # fmt: skip
    assert within_3_errors(died, 4.0)
