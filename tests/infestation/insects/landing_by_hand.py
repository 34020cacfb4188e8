"""Where jumps land on a small plot, plant by plant."""

import numpy as np

from fieldmon.infestation.insects.jump_landing import landing_of
from fieldmon.plot.layout import rectangle

PLOT = rectangle(9, 8)
N = len(PLOT)
LANDING = landing_of(PLOT)
SHARES = np.array([0.3, 0.2, 0.2, 0.1, 0.05, 0.05, 0.05, 0.05])


def by_hand(shares):
    """Return what lands on each plant (columns) of what each sends (rows)."""
    half = LANDING.kernels.shape[1] // 2
    kernel = np.einsum("k,kij->ij", shares, LANDING.kernels)
    y, x = np.divmod(LANDING.cells.of_plant, LANDING.cells.shape[1])
    return kernel[half + y[None, :] - y[:, None], half + x[None, :] - x[:, None]]
