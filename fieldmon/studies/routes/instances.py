"""Reward matrices: read from files, and drawn by the published recipes from a seed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fieldmon.errors import FileProblem

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Float = NDArray[np.float64]

EXPONENTS = (0.0, 0.8, 1.9, 2.7)
SHAPES = ((100, 50), (50, 100))
MAP_SHAPES = ((240, 500), (274, 214))
# rewards are whole numbers from 0 up to this where they are drawn by Zipf's law
_MOST_REWARD = 100


class Instance(NamedTuple):
    """A name and a reward ``(m, n)`` for each plant of m rows."""

    name: str
    reward: Float


def full_budget(n_rows: int, n_plants: int) -> int:
    """Return the steps that published budgets are shares of.

    ``m c + 3 m`` for m rows of c = n + 2 places, headlands included: each row driven through, and
    some headland. With many rows it is a little more than driving everything takes.
    """
    return n_rows * (n_plants + 2) + 3 * n_rows


def read_matrix(text: str, name: str) -> Instance:
    """Return the reward matrix of a CSV text: one line a row, numbers of 0 or more."""
    lines = [line for line in text.splitlines() if line.strip()]
    rows = []
    for number, line in enumerate(lines, 1):
        try:
            rows.append([float(value) for value in line.replace(";", ",").split(",")])
        except ValueError as error:
            raise FileProblem(
                f"{name} must hold numbers separated by commas, but line {number} does not: "
                f"{line[:40]!r}."
            ) from error
    if not rows or len({len(row) for row in rows}) != 1:
        raise FileProblem(
            f"{name} must hold one line of rewards a row, all of one length, but it has "
            f"{len(rows)} lines of {sorted({len(row) for row in rows})} numbers."
        )
    reward = np.array(rows)
    if not (np.isfinite(reward).all() and (reward >= 0).all()):
        raise FileProblem(f"{name} must hold rewards of 0 or more, but it does not.")
    return Instance(name, reward)


def zipf(shape: tuple[int, int], exponent: float, seed: int) -> Instance:
    """Return rewards 0 to 100 with chances that fall by Zipf's law; exponent 0 is even.

    Doubt: the papers state the exponents, not the least and the most reward.
    """
    rng = np.random.default_rng([seed, *shape, round(10 * exponent)])
    value = np.arange(_MOST_REWARD + 1)
    chance = (value + 1.0) ** -exponent
    reward = rng.choice(value, size=shape, p=chance / chance.sum()).astype(float)
    return Instance(f"zipf {exponent:g} {shape[0]}x{shape[1]} seed {seed}", reward)


def smooth_map(shape: tuple[int, int], seed: int) -> Instance:
    """Return a map of wide waves, as soil moisture makes: 0 to 100."""
    reward = _waves(shape, 0.25, np.random.default_rng([seed, *shape, 1]))
    return Instance(f"smooth {shape[0]}x{shape[1]} seed {seed}", np.round(100 * reward, 1))


def patchy_map(shape: tuple[int, int], seed: int) -> Instance:
    """Return a map that is empty but for patches, as pests make: 0 to 100."""
    reward = _waves(shape, 0.03, np.random.default_rng([seed, *shape, 2]))
    patches = np.maximum(reward - np.quantile(reward, 0.9), 0.0)
    return Instance(
        f"patchy {shape[0]}x{shape[1]} seed {seed}", np.round(100 * patches / patches.max(), 1)
    )


def families(seed: int, *, maps: bool = True) -> Iterator[Instance]:
    """Yield the published families, one instance each."""
    for shape in SHAPES:
        for exponent in EXPONENTS:
            yield zipf(shape, exponent, seed)
    for shape in MAP_SHAPES if maps else ():
        yield smooth_map(shape, seed)
        yield patchy_map(shape, seed)


def _waves(shape: tuple[int, int], width: float, rng: np.random.Generator) -> Float:
    """Return even noise smoothed over a share of the plot, from 0 to 1."""
    noise = np.fft.rfft2(rng.standard_normal(shape))
    down, along = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])
    # widths in plants: rows are as far apart as some plants in a row, both directions count alike
    across, within = width * shape[0], width * shape[1]
    keep = np.exp(-2.0 * np.pi**2 * ((down * across) ** 2 + (along * within) ** 2))
    waves: Float = np.fft.irfft2(noise * keep, s=shape)
    low, high = waves.min(), waves.max()
    scaled: Float = (waves - low) / (high - low)
    return scaled
