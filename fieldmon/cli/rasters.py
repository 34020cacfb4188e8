"""What `fieldmon plan` does with rasters: risk, missing plants, the chance map as GeoTIFF."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol, TypeVar

import typer

from fieldmon.errors import ChoiceNeeded, SettingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import numpy as np
    from numpy.typing import NDArray

    from fieldmon.infestation.raster_risk import RiskSettings
    from fieldmon.io.import_report import ImportMessage
    from fieldmon.io.rasters.values import How, RasterOptions
    from fieldmon.plot.plot import Plot

Read = TypeVar("Read")

Risk = Annotated[
    Path | None,
    typer.Option(help="GeoTIFF of the risk of infestation, one more way to be infested."),
]
RiskChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--risk-option",
        help="What the risk raster means, as NAME=VALUE: meaning=chance (0..1), percent, rank or "
        "score; mean_share=0.02 and low_is_risky=yes with rank and score; how=mean, highest, "
        "nearest or bilinear; and band, crs, nodata, member.",
    ),
]
Canopy = Annotated[
    Path | None,
    typer.Option(help="GeoTIFF of the canopy (height, NDVI): where it is low no plant stands."),
]
CanopyBelow = Annotated[
    float | None, typer.Option(help="A plant is missing where the canopy is below this.")
]
CanopyChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--canopy-option",
        help="How the canopy is read, as NAME=VALUE: how=highest, mean, nearest or bilinear; and "
        "band, crs, nodata, member.",
    ),
]
ChanceMap = Annotated[
    Path | None, typer.Option(help="Cloud Optimised GeoTIFF to write: chance of each plant.")
]


class Tell(Protocol):
    """Tells a person what an import has to say about a file, and keeps it where it is noted."""

    def __call__(
        self, findings: Iterable[ImportMessage], source: object = "", flag: str = "", /
    ) -> None:
        """Tell findings about a source; `flag` takes their remedies."""


def without_missing(
    plot: Plot, canopy: Path | None, below: float | None, more: list[str] | None, tell: Tell
) -> Plot:
    """Return the plot without the plants where the canopy is low; those unseen stay."""
    if canopy is None and below is None and not more:
        return plot
    if canopy is None or below is None:
        raise SettingError(
            "Missing plants are found with both --canopy FILE and --canopy-below X: give both."
        )

    from fieldmon.io.rasters.at_plants import read_missing  # noqa: PLC0415

    flag = "--canopy-option"
    options, how = _options(_pairs(more, flag))
    read = _asked(lambda: read_missing(canopy, options, plot, below, how), flag)
    tell(read.messages, canopy, flag)
    return plot.without(read.value)


def risk_of(
    plot: Plot, path: Path | None, more: list[str] | None, tell: Tell
) -> NDArray[np.float64] | None:
    """Return the risk of each plant from a raster ``(n,)``, NaN where it says nothing."""
    if path is None:
        if more:
            raise SettingError("--risk-option says how to read a raster: give it with --risk FILE.")
        return None
    from fieldmon.io.rasters.at_plants import read_risk  # noqa: PLC0415

    flag = "--risk-option"
    given = _pairs(more, flag)
    settings = _risk_settings(given)
    options, how = _options(given)
    read = _asked(lambda: read_risk(path, options, plot, settings, how), flag)
    tell(read.messages, path, flag)
    return read.value


def write_map(to: Path | None, plot: Plot, chance: NDArray[np.float64]) -> None:
    """Write the chance map, if it was asked for."""
    if to is None:
        return
    from fieldmon.io.writers.chance_raster import write_chance_raster  # noqa: PLC0415

    made = write_chance_raster(plot.grid, chance, to)
    high, wide = made.values.shape
    typer.echo(
        f"Chance map written to {to} ({wide} x {high} pixels of {made.pixel_m:g} m, {made.crs})"
    )


def _options(given: dict[str, str]) -> tuple[RasterOptions, How | None]:
    """Return how a raster is read, and how it is to be sampled where that was said."""
    from fieldmon.io.rasters.read import RasterOptions  # noqa: PLC0415

    how: Any = given.pop("how", None)
    options = RasterOptions()
    for name, value in given.items():
        options = options.choose(name, value)
    return options, how


def _asked(read: Callable[[], Read], flag: str) -> Read:
    """Return what is read; where the raster leaves a choice, name the option to answer with."""
    try:
        return read()
    except ChoiceNeeded as question:
        answer = question.choices[0] if question.choices else "..."
        raise ChoiceNeeded(
            f'{question} Answer with {flag} {question.option}="{answer}", for instance.',
            question.option,
            question.choices,
        ) from None


def _risk_settings(given: dict[str, str]) -> RiskSettings:
    """Return what was said of the meaning, taken out of the options."""
    from fieldmon.infestation.raster_risk import RiskSettings  # noqa: PLC0415

    said: dict[str, Any] = {
        name: given.pop(name) for name in [f.name for f in fields(RiskSettings)] if name in given
    }
    if "mean_share" in said:
        said["mean_share"] = _number(said["mean_share"])
    if "low_is_risky" in said:
        said["low_is_risky"] = said["low_is_risky"].lower() in {"yes", "true", "1"}
    return replace(RiskSettings(), **said)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise SettingError(
            f"mean_share must be a number such as 0.02, but it is {text!r}."
        ) from None


def _pairs(more: list[str] | None, flag: str) -> dict[str, str]:
    pairs = {}
    for item in more or []:
        name, equals, value = item.partition("=")
        if not equals:
            raise SettingError(f"{flag} must be NAME=VALUE, but it is {item!r}.")
        pairs[name.strip()] = value.strip()
    return pairs
