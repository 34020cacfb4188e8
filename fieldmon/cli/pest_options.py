"""What is looked for, and the weather that it meets, as options. Heavy imports wait."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.messages import FLAGS, Terminal, tell_assumed
from fieldmon.cli.named_values import chosen
from fieldmon.errors import ChoiceNeeded, SettingError
from fieldmon.io.packaged import pest_names

if TYPE_CHECKING:
    from datetime import date

    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.prior.prior_settings import PriorSettings
    from fieldmon.pests.pest import Pest
    from fieldmon.pests.weather import Weather
    from fieldmon.plot.field import Field
    from fieldmon.plot.robot import Robot

PestName = Annotated[
    str | None,
    typer.Option(
        "--pest",
        help=f"The pest: a file (TOML), or {', '.join(pest_names())}.",
    ),
]
WeatherFile = Annotated[
    Path | None,
    typer.Option(
        "--weather",
        help="Weather by hours or days: CSV or Excel of a station, or IPM Decisions' JSON.",
    ),
]
WeatherChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--weather-option",
        help="What the weather file does not say, as NAME=VALUE: zone=Asia/Jerusalem, "
        "wind_unit=km/h, temperature_unit=F, rain_unit=in, rain_is=each, date_order=dmy, "
        "location=1.",
    ),
]

#: why options of spread do not go with a pest, and what to do instead
SAYS_ITSELF = "how it spreads stands in its file, under [movement]"


@dataclass(frozen=True)
class PestOptions:
    """The pest, and the file of its weather."""

    pest: PestName = None
    weather: WeatherFile = None
    weather_option: WeatherChoices = None

    def named(self) -> Pest | None:
        """Return the pest that was named; None: none was."""
        from fieldmon.io.readers.pest_file import pest_of

        return None if self.pest is None else pest_of(self.pest)

    def check_alone(self, **given: object) -> None:
        """Raise `SettingError` where a pest is named and options say how it spreads as well."""
        said = [f"--{name}" for name, value in given.items() if value is not None]
        if self.pest is not None and said:
            verb = "goes" if len(said) == 1 else "go"
            raise SettingError(f"{' and '.join(said)} {verb} without --pest: {SAYS_ITSELF}.")

    def met(self, field: Field) -> Weather | None:
        """Return the weather that was given, and print what there is to say of it."""
        if self.weather is None:
            if self.weather_option:
                raise SettingError("--weather-option goes with --weather. Give the file too.")
            return None
        from fieldmon.io.read import read_weather
        from fieldmon.io.readers.weather_options import WeatherOptions
        from fieldmon.plot.local_clock import utc_now

        options = chosen(WeatherOptions(now=utc_now()), self.weather_option).on(field)
        with Terminal().answering():
            try:
                read = read_weather(self.weather, options)
            except ChoiceNeeded as asked:
                raise ChoiceNeeded(asked.args[0], asked.option, asked.choices, "weather") from None
        for message in read.messages:
            typer.echo(message.line(FLAGS["weather"]), err=True)
        return read.value

    def seen(self, robot: Robot) -> Robot:
        """Return the robot with the pest's own chance of detection, if it has one."""
        from fieldmon.pests.pest import seen_by_pest

        return seen_by_pest(robot, self.named())

    def in_weather(self, field: Field, begins: date) -> PestInWeather | None:
        """Return the pest in its weather from a day on; None: no pest was named."""
        from fieldmon.infestation.insects.pest_in_weather import PestInWeather

        pest, weather = self.named(), self.met(field)
        if pest is None:
            if weather is not None:
                raise SettingError(
                    "--weather goes with --pest, which says what warmth does. Give a pest too, "
                    "as --pest spider-mite."
                )
            return None
        tell_pest(pest)
        return PestInWeather(pest, weather, begins)


def pest_in_weather_of(name: str | None) -> PestInWeather | None:
    """Return the pest that a study named, at the temperature of its figures; None: none was."""
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather

    pest = PestOptions(name).named()
    if pest is None:
        return None
    tell_pest(pest)
    return PestInWeather(pest)


def check_no_pest(name: str | None, study: str) -> None:
    """Raise `SettingError` if a pest was named for a study of what was published."""
    if name is not None:
        raise SettingError(
            f"{study} goes without --pest: it is held against figures that were published of the "
            "thesis's own rule. For another pest take study prior, samplers or run."
        )


def prior_of(
    pest_in_weather: PestInWeather | None, on: date, background: float | None = None
) -> PriorSettings:
    """Return how records become chances for a day, as the pest and its weather have it.

    `background` is the chance of a plant of which nothing is known; None: the usual.
    """
    from fieldmon.infestation.prior.pest_prior import prior_for
    from fieldmon.infestation.prior.prior_settings import PriorSettings

    usual = PriorSettings()
    if background is not None:
        usual = replace(usual, background_chance=background)
    if pest_in_weather is None:
        return usual
    made = prior_for(usual, pest_in_weather.pest, pest_in_weather.weather, on)
    tell_half_life(made, usual)
    return made


def tell_half_life(prior: PriorSettings, before: PriorSettings) -> None:
    """Print after how many days records count half, if it was otherwise before."""
    if prior.half_life_days == before.half_life_days:
        return
    usual = prior.half_life_days == type(prior)().half_life_days
    why = "." if usual else ": the last generation took so long in this weather."
    typer.echo(f"Records count half after {prior.half_life_days:g} days{why}", err=True)


def tell_pest(pest: Pest) -> None:
    """Print the pest, which of its figures to doubt, and what is assumed for want of one."""
    typer.echo(f"pest: {pest.title or pest.name}", err=True)
    tell_assumed(pest.assumed)
    for citation in pest.citations:
        if citation.doubt:
            typer.echo(f"doubtful: {citation.part}: {citation.doubt}", err=True)
