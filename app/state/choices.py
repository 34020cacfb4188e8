"""What the person chose, as one frozen value that every page gets."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import date
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.writers.file_names import plain_name
from fieldmon.monitoring.phones import photos_asked
from fieldmon.planning.plan import PlanSettings
from fieldmon.planning.wishes import Wishes
from fieldmon.plot.local_clock import LocalClock, local_clock
from fieldmon.samplers import sampler

from ..words import texts
from . import browser, cached, widget_memory, wishes

if TYPE_CHECKING:
    from fieldmon.errors import FieldmonError
    from fieldmon.infestation.records import Records
    from fieldmon.monitoring import Season
    from fieldmon.planning.plan import DayPlan
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot
    from fieldmon.reports.day import DayFacts
    from fieldmon.samplers.base import Sampler

    from ..words.units import UnitsInLanguage
    from .brought_files import FileMessage, LeftOut

#: the box that says whose day of a team is shown
WHOSE_DAY = "whose_day"


@dataclass(frozen=True, eq=False)
class Choices:
    """What the person chose, read and laid out.

    Parameters
    ----------
    key
        Stands for the plot and the records in cache keys.
    plot, records
        The plot with its plants, and the records near it.
    messages
        What the imports had to say.
    robot, sampler, day
        Who inspects, who chooses, and for which day (ISO).
    units
        How numbers are written.
    season
        The season that is open, or None: nothing is kept then.
    plot_key
        Names the plot before anything was drawn on it.
    risk
        ``(n,)`` risk of the plants from a raster, or None; a season has taken it in.
    today
        The date on the plot now; None: that of the day.
    prior
        How records become chances; a season has its own.
    left_out
        Files that could not be used: what is shown does without them, and says so.
    """

    key: str
    plot: Plot
    records: Records
    messages: tuple[FileMessage, ...]
    robot: Robot
    sampler: str
    day: str
    units: UnitsInLanguage
    season: Season | None = None
    plot_key: str = ""
    risk: cached.Array | None = None
    today: date | None = None
    left_out: tuple[LeftOut, ...] = ()
    prior: PriorSettings = field(default_factory=PriorSettings)

    @property
    def open_season(self) -> Season:
        """Return the season that is open, for what only a season has: there must be one."""
        if self.season is None:
            raise RuntimeError(
                f"A season must be open on {self.plot.field.name}, but none is. Ask whether "
                "`season` is None before what only a season has."
            )
        return self.season

    @property
    def name(self) -> str:
        """Return the plot's name, apart from the text around it, whatever its script."""
        return texts.isolated(self.plot.field.name)

    def file_name(self, of: str, who: str = "") -> str:
        """Return the name of a file of the day, without its ending: whose it is stands in it."""
        named = self.plot.field.name if self.season is None else self.season.path.stem
        return "_".join([of, *(plain_name(one) for one in (named, who) if one), self.day])

    @property
    def on(self) -> date:
        """Return the day."""
        return date.fromisoformat(self.day)

    @property
    def is_today(self) -> bool:
        """Return whether the day is today on the plot."""
        return self.today is None or self.on == self.today

    @property
    def is_past(self) -> bool:
        """Return whether the day is over on the plot."""
        return self.today is not None and self.on < self.today

    @property
    def clock(self) -> LocalClock:
        """Return the clock of the plot's time zone."""
        return local_clock(self.plot.field)

    @property
    def revision(self) -> str:
        """Return what changes with everything that is recorded."""
        return "" if self.season is None else self.season.revision

    @property
    def dark(self) -> bool:
        """Return whether the page is dark."""
        return browser.is_dark()

    @property
    def place(self) -> str:
        """Return what a plot and the season that begins on it have in common."""
        edges = self.plot.field.boundary.bounds
        return " ".join([self.plot.field.name, *(f"{edge:.5f}" for edge in edges)])

    @property
    def laid(self) -> str:
        """Return the same of plants as they are laid: numbers of plants mean nothing elsewhere."""
        grid = self.plot.grid
        some = grid.lonlat(np.linspace(0, len(grid) - 1, 4).astype(np.intp))
        return " ".join([self.place, str(len(grid)), *(f"{one:.5f}" for one in some.flat)])

    @property
    def besides(self) -> Wishes:
        """Return which plants are picked to be inspected too, or not: here, or kept of the day."""
        if self.season is None or wishes.were_told(self.laid, self.day):
            return wishes.of(self.laid, self.day)
        return cached.wishes_kept(self.key, self.revision, self.day, self.season)

    @property
    def are_wishes_unused(self) -> bool:
        """Return whether other plants are picked here than are kept of the season's day."""
        if self.season is None or not wishes.were_told(self.laid, self.day):
            return False
        return self.besides != cached.wishes_kept(self.key, self.revision, self.day, self.season)

    @property
    def wishes(self) -> Wishes:
        """Return what people want of the day besides, the plants to be photographed among it."""
        picked = self.besides
        if self.season is None or self.is_past:
            return picked
        asked = {one.plant for one in photos_asked.photos_asked(self.season)}
        return Wishes(tuple(sorted({*picked.wanted, *asked} - {*picked.unwanted})), picked.unwanted)

    @property
    def team(self) -> tuple[str, ...]:
        """Return the names of a season's team of now; none where one works."""
        if self.season is None:
            return ()
        return tuple(member.name for member in self.season.settings.team)

    @property
    def team_that_day(self) -> tuple[str, ...]:
        """Return the names of the team that the day is planned for, or was worked by."""
        if self.season is None:
            return ()
        return tuple(member.name for member in self.season.planned_by(self.on).team)

    @property
    def whose_day(self) -> str | None:
        """Return whose day is shown, of the team of that day; None where one works.

        What is recorded is signed so only where somebody's own route is shown and worked: of what
        else is done nobody said who did it.
        """
        if not (team := self.team_that_day):
            return None
        chosen = widget_memory.value(WHOSE_DAY)
        return chosen if chosen in team else team[0]

    @property
    def decides(self) -> Sampler:
        """Return the sampler; that of a season as it was told to work that day."""
        if self.season is None:
            return sampler(self.sampler)
        return self.season.planned_by(self.on).decides()

    def plan(self) -> DayPlan:
        """Return the planned day: what is left of it, once something of it was recorded."""
        return self.plan_of(self.whose_day)

    def plan_of(self, who: str | None) -> DayPlan:
        """Return the planned day of one of a season's team; None where one works."""
        if self.season is not None:
            of = self.day, who
            now = cached.revision_on(self.season, self.on, who)
            return cached.season_plan_now(self.key, now, self._minute, of, self.season, self.wished)
        known = self.records, self.risk
        settings = PlanSettings(self.robot, self.decides, self.prior)
        return cached.day_plan(
            self.key, self.day, settings, self.sampler, self.plot, known, self.wishes
        )

    def day_of_each(self) -> tuple[DayFacts, ...]:
        """Return the season's day for its report and, where several work, that of each of them."""
        season = self.open_season
        now = cached.revision_on(season, self.on), self._minute
        days = self.day, self.today
        return cached.day_of_each(self.key, now, days, season, self.wished)

    @property
    def wished(self) -> tuple[Wishes, bool]:
        """Return what people want of the day, and whether anybody ever wanted something of it."""
        return self.wishes, wishes.were_told(self.laid, self.day)

    @property
    def _minute(self) -> str:
        """The minute by the plot's clock while the day is today: hours run by it."""
        return f"{self.clock.now():%F %H:%M}" if self.is_today else ""


@dataclass(frozen=True, eq=False)
class Chosen:
    """The choices, or why there are none yet (neither: nothing was brought)."""

    choices: Choices | None = None
    problem: FieldmonError | None = None
