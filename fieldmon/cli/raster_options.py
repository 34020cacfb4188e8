"""Rasters about a plot that commands are given: risk and canopy. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldmon.cli.named_values import named_values
from fieldmon.cli.option_ranges import within
from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from fieldmon.infestation.prior.raster_risk import RiskSettings
    from fieldmon.io.plot_request import CanopySource, RiskSource
    from fieldmon.io.rasters.values import How, RasterOptions

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
    typer.Option(help="GeoTIFF of the canopy (height, NDVI): plants are missing where it is low."),
]
CanopyBelow = Annotated[
    float | None,
    typer.Option(
        help="A plant is missing where the canopy is below this.", callback=within(-1e9, 1e9)
    ),
]
CanopyChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--canopy-option",
        help="How the canopy is read, as NAME=VALUE: how=highest, mean, nearest or bilinear; and "
        "band, crs, nodata, member.",
    ),
]


@dataclass(frozen=True)
class RasterFiles:
    """Rasters about a plot, and what they mean."""

    risk: Risk = None
    risk_option: RiskChoices = None
    canopy: Canopy = None
    canopy_below: CanopyBelow = None
    canopy_option: CanopyChoices = None

    def canopy_source(self) -> CanopySource | None:
        """Return the raster that shows which plants are missing, if there is one."""
        if self.canopy is None and self.canopy_below is None and not self.canopy_option:
            return None
        if self.canopy is None or self.canopy_below is None:
            raise SettingError(
                "Missing plants are found with both --canopy FILE and --canopy-below X: give both."
            )
        from fieldmon.io.plot_request import CanopySource

        options, how = _options(dict(named_values(self.canopy_option, "--canopy-option")))
        return CanopySource(self.canopy, self.canopy_below, options, how)

    def risk_source(self) -> RiskSource | None:
        """Return the raster of the risk and what its numbers mean, if there is one."""
        if self.risk is None:
            if self.risk_option:
                raise SettingError(
                    "--risk-option says how to read a raster: give it with --risk FILE."
                )
            return None
        from fieldmon.io.plot_request import RiskSource

        given = dict(named_values(self.risk_option, "--risk-option"))
        settings = _risk_settings(given)
        options, how = _options(given)
        return RiskSource(self.risk, settings, options, how)


def _options(given: dict[str, str]) -> tuple[RasterOptions, How | None]:
    """Return how a raster is read, and how it is to be sampled where that was said."""
    from fieldmon.io.rasters.read import RasterOptions

    how: Any = given.pop("how", None)
    options = RasterOptions()
    for name, value in given.items():
        options = options.choose(name, value)
    return options, how


def _risk_settings(given: dict[str, str]) -> RiskSettings | None:
    """Return what was said of the meaning, taken out of the options; None: nothing."""
    from fieldmon.infestation.prior.raster_risk import RiskSettings
    from fieldmon.io.options import yes_or_no

    said: dict[str, Any] = {
        name: given.pop(name) for name in [f.name for f in fields(RiskSettings)] if name in given
    }
    if "mean_share" in said:
        said["mean_share"] = _number(said["mean_share"])
    if "low_is_risky" in said:
        said["low_is_risky"] = yes_or_no("low_is_risky", said["low_is_risky"])
    if not said:
        return None
    if "meaning" not in said:
        raise SettingError(
            f"{' and '.join(said)} of a risk raster must go with what its numbers mean, but that "
            "is not said. Add --risk-option meaning=rank or meaning=score."
        )
    return RiskSettings(**said)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise SettingError(
            f"mean_share must be a number such as 0.02, but it is {text!r}."
        ) from None
