"""What a season knows: chances, counts, forecasts and advice for a day."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.decisions.map_verdict import verdict_of
from fieldmon.decisions.sequential import LEAVE
from fieldmon.errors import SettingError
from fieldmon.infestation.earlier_season import EarlierSeason
from fieldmon.infestation.inspections import FOUND, SKIPPED
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.infestation.tracing.traced_pairs import TracedPairs
from fieldmon.monitoring.advice.advice import advice
from fieldmon.monitoring.advice.left_plot import FewInspected, InspectAgain, NotReached
from fieldmon.monitoring.estimates import day_figures
from fieldmon.monitoring.estimates.last_days import default_date
from fieldmon.monitoring.estimates.season_contents import MorningAsked
from fieldmon.monitoring.estimates.status import Status
from fieldmon.monitoring.estimates.told_detection import other_detections
from fieldmon.monitoring.season.season_days import SeasonDays
from fieldmon.monitoring.settings.advice_settings import AdviceSettings
from fieldmon.pests.development import development

if TYPE_CHECKING:
    from collections.abc import Iterator
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.compute.day_arguments import Day
    from fieldmon.decisions.map_verdict import MapVerdict
    from fieldmon.infestation.forecast import Forecast
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.monitoring.advice.advice import Advice
    from fieldmon.monitoring.estimates.day_figures import DayFigures
    from fieldmon.monitoring.estimates.season_contents import SeasonContents
    from fieldmon.monitoring.estimates.told_detection import ToldOtherwise
    from fieldmon.pests.development import Development

    Floats = NDArray[np.float64]


@checked
class SeasonEstimates(SeasonDays):
    """What follows on each day from all that was recorded before."""

    def morning(self, on: Day) -> Floats:
        """Return the chance map ``(n,)`` of the morning of `on`; it is yours to change."""
        with self._asked(on) as (_, morning, _):
            return morning.chance.copy()

    def evening(self, on: Day) -> Floats:
        """Return the chance map ``(n,)`` of `on`, after what was recorded of it so far.

        What is left of the day is planned by it, as far as it can be seen.
        """
        with self._asked(on) as (contents, morning, day):
            return contents.history.in_hindsight(morning, day).chance.copy()

    def level_range(self, on: Day) -> LevelRange:
        """Return how far the chances of `evening` may be off together: 90 %, on the odds."""
        with self._asked(on) as (contents, morning, day):
            return contents.history.level_range(morning, day)

    def verdict(
        self, on: Day, level: float, sure: float = 0.9, plants: NDArray[np.bool_] | None = None
    ) -> MapVerdict:
        """Return whether treating pays after a day's work; see `fieldmon.decisions`.

        Plants that were found and not treated count: they are infested.

        Parameters
        ----------
        on
            The day.
        level
            Share of infested plants from which treating pays.
        sure
            How likely the answer must be to be right.
        plants
            ``(n,)`` the part of the plot that is asked about; None: all.
        """
        with self._asked(on) as (contents, morning, day):
            evening = contents.history.in_hindsight(morning, day)
        found = contents.history.found_and_left(evening, day)
        said = verdict_of(contents.history.grid, evening, level, sure, found, plants=plants)
        return said.where(inspected=len(contents.history.inspected(day)) > 0)

    def advice(self, on: Day, asked: AdviceSettings | None = None) -> Advice:
        """Return whether to treat after a day's work, where, and how many looks decide.

        Parameters
        ----------
        on
            The day.
        asked
            The threshold, the sprayer and the costs; None: the defaults.
        """
        with self._lock, self.store.reading() as db:  # all of one moment
            contents = self._read(db)
            day = contents.settings.day(on)
            scene = self._scene(contents, on, read=db)
            morning = contents.morning(day)
            evening = contents.history.in_hindsight(morning, day)
            told = db.execute("SELECT 1 FROM observations").fetchone()
        history, asked = contents.history, asked or AdviceSettings()
        done = tuple(one for one in history.treatments if one.day == day)
        found = history.found_and_left(evening, day)
        inspected = history.inspected(day)
        seen = scene if len(inspected) else None
        made = advice(history.grid, evening, asked, seen, done, found)
        made = replace(made, finds_treated=history.belief.treated)
        if seen is None:
            away = NotReached.of(history.grid, inspected)
            return replace(made.before_inspections(), not_reached=away)
        if made.verdict != LEAVE:
            return made
        ahead = history.forecast(morning, day)  # others may plan meanwhile
        return replace(
            made,
            again=InspectAgain.of(ahead, on, asked.level * len(history.grid)),
            not_reached=NotReached.of(history.grid, inspected),
            few=self._few(contents, day, asked, records=told is not None),
        )

    def _few(
        self, contents: SeasonContents, day: int, asked: AdviceSettings, *, records: bool
    ) -> FewInspected | None:
        """Return that few plants were inspected; None: enough, or finds and treatments tell."""
        history = contents.history
        done = history.until(day)
        treated = any(one.day <= day for one in history.treatments)
        if treated or (done.result == FOUND).any():
            return None
        background = contents.settings.prior.background_chance
        told = records or self.risk is not None or history.belief.earlier is not None
        assumed = not told and background == PriorSettings().background_chance
        plants = len(np.unique(history.inspected(day))), len(history.grid)
        detects = history.mean_detection(day)
        return FewInspected.of(plants, asked, detects, background if assumed else None)

    def status(self, on: Day) -> Status:
        """Return where the season stands on a day."""
        with self._asked(on) as (contents, morning, day):
            now = Status.of(contents.history, morning, day)
        return replace(now, development=_development(contents, on))

    def development(self, on: Day) -> Development | None:
        """Return how far the pest has come on a day, counted from its first find.

        Until there is one, from the season's first day. None: no pest or weather was given, or
        its development is not known.
        """
        return _development(self._now(), on)

    def forecast(self, on: Day) -> Forecast:
        """Return how many plants are infested on the mornings after a day, nobody inspecting."""
        with self._asked(on) as (contents, morning, day):
            history = contents.history
        return history.forecast(morning, day)  # others may plan meanwhile

    def learnt(self, on: Day, detection: float | None = None) -> tuple[Learnt, ...]:
        """Return what the inspections up to the evening of `on` tell of the insects.

        Parameters
        ----------
        on
            The day.
        detection
            What inspections are told to detect; None: as those made until then.
        """
        with self._asked(on) as (contents, morning, day):
            return contents.history.learnt(morning, day, detection)

    def other_detections(self, on: Day) -> tuple[ToldOtherwise, ...]:
        """Return with which inspections up to `on` another detection was said than the season's."""
        with self._lock, self.store.reading() as db:
            now = self._read(db)
            done = now.history.until(now.settings.day(on))
            return other_detections(db, done, now.settings.begins)

    def as_earlier(self) -> EarlierSeason:
        """Return what the season learnt until its last day, or today, as a next one may begin so.

        Raise `SettingError` if it learnt nothing: nothing was inspected, or finds are not traced.
        """
        on = default_date(self)
        with self._asked(on) as (contents, morning, day):
            evening = contents.history.evening(morning, day)
        inspected = (contents.history.inspections.result != SKIPPED).any()
        if not isinstance(evening, TracedPairs) or not inspected:
            raise SettingError(
                worded(
                    "An earlier season must have learnt of its insects, but in {name} {why}. "
                    "Begin without it.",
                    name=self.path.name,
                    why=worded("finds are traced to neighbours only")
                    if inspected
                    else worded("nothing was inspected"),
                )
            )
        settings, plot = contents.settings, self.plot
        told = settings.robot.detects if settings.team else contents.history.mean_detection(day)
        believed = settings.belief.believed(plot.grid, settings.pest, told)
        return EarlierSeason.of(evening, believed, plot.field.name, on)

    def days(self) -> tuple[DayFigures, ...]:
        """Return the figures of the days on which anything was planned or recorded, in order."""
        with self.store.reading() as db:
            return day_figures.kept(db)

    @contextmanager
    def _asked(self, on: date) -> Iterator[MorningAsked]:
        """Give what a question about a day is answered from; others wait, or would do it again."""
        with self._lock:
            yield MorningAsked.of(self._now(), on)


def _development(now: SeasonContents, on: date) -> Development | None:
    pest, weather = now.settings.pest, now.settings.weather
    if pest is None or weather is None:
        return None
    return development(pest, weather, now.history.first_find(on) or now.settings.begins, on)
