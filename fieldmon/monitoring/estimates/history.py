"""A real season so far: what was inspected and treated, and what that says each morning."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field, replace
from datetime import timedelta
from functools import cached_property
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np

from fieldmon.compute.wording import worded
from fieldmon.errors import ObservationError
from fieldmon.infestation.ancestry.origins import Estimate
from fieldmon.infestation.chance_bounds import KNOWN
from fieldmon.infestation.forecast import NIGHTS, Forecast, forecast
from fieldmon.infestation.inspections import FOUND, SKIPPED, Inspections
from fieldmon.infestation.learnt import learnt_from, with_start
from fieldmon.infestation.level_range import level_range
from fieldmon.infestation.plot_estimate import estimate_of
from fieldmon.infestation.records import PRESENT
from fieldmon.infestation.tracing.traced_pairs import in_hindsight, in_sight
from fieldmon.io.parse.result_words import says_gone
from fieldmon.monitoring.estimates.still_infested import (
    infested_in_all,
    not_found_yet,
    still_certain,
)
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.settings.shift_work import ShiftWork
from fieldmon.pests.weather import DAY_S
from fieldmon.planning.skips import Skips, without_flagged, without_skipped
from fieldmon.plot.local_clock import grid_clock
from fieldmon.samplers.base import NEVER, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.infestation.belief import Belief
    from fieldmon.infestation.insects.pest_in_weather import PestInWeather
    from fieldmon.infestation.insects.spread import Spread
    from fieldmon.infestation.learnt import Learnt
    from fieldmon.infestation.level_range import LevelRange
    from fieldmon.infestation.plot_estimate import PlotEstimate
    from fieldmon.monitoring.settings.shift_work import Besides, Shift
    from fieldmon.monitoring.treating.treatment import Treatment
    from fieldmon.plot.grid import PlantGrid


_T = TypeVar("_T")
# once this share of the inspections was made later, the first evening says hardly anything of the
# start, and working it out again takes time
_HARDLY_FIRST = 0.99


class _Last(Generic[_T]):
    """What was worked out last, of a morning and its day: once for all who ask."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._made: tuple[Belief, int, _T] | None = None

    def of(self, morning: Belief, day: int, work: Callable[[Belief, int], _T]) -> _T:
        """Return what `work` makes of a morning and a day."""
        with self._lock:
            made = self._made
            if made is None or made[0] is not morning or made[1] != day:
                made = self._made = morning, day, work(morning, day)
            return made[2]

    def keep(self, morning: Belief, day: int, made: _T) -> None:
        """Take this for what was made of them."""
        self._made = morning, day, made


@dataclass(frozen=True, eq=False)
class History:
    """All that happened on a plot since its season began.

    Parameters
    ----------
    grid
        The plants.
    begins
        The first day; days are counted from it, from 0.
    first_morning
        What is believed on its morning.
    inspections, treatments
        What was done; inspections in the order in which they were made.
    belief
        What is made of it.
    detection
        Chance that an inspection finds what is there, as it was told when it was made: one for
        all, or ``(k,)`` of each.
    recorded
        ``(n,)`` what the records say from which the season began: 1 infested, 0 clean, -1 nothing;
        None: there are none.
    pest_in_weather
        The pest, in the weather of the season's days; None: nobody named it, and nights are as
        `belief` says.
    """

    grid: PlantGrid
    begins: date
    first_morning: Belief
    inspections: Inspections = field(default_factory=Inspections.none)
    treatments: tuple[Treatment, ...] = ()
    belief: BeliefSettings = field(default_factory=BeliefSettings)
    detection: float | NDArray[np.float64] = 0.84
    recorded: NDArray[np.int8] | None = None
    pest_in_weather: PestInWeather | None = None

    def __post_init__(self) -> None:
        if (np.diff(self.days) < 0).any():
            raise ObservationError(worded("Inspections must be in the order of their days."))

    @cached_property
    def days(self) -> NDArray[np.int32]:
        """Number of the day of each inspection, ``(k,)``."""
        since = self.inspections.date - np.datetime64(self.begins, "D")
        return since.astype(np.int32)

    @cached_property
    def detections(self) -> NDArray[np.float64]:
        """Chance that each inspection finds what is there, as it was told, ``(k,)``."""
        return np.broadcast_to(np.asarray(self.detection, np.float64), self.days.shape)

    def date_of(self, day: int) -> date:
        """Return the date of a day."""
        return self.begins + timedelta(days=day)

    def on(self, day: int) -> Inspections:
        """Return the inspections of a day."""
        return self.inspections.take(self._rows_of(day))

    def _rows_of(self, day: int) -> slice:
        return slice(*np.searchsorted(self.days, [day, day + 1]))

    def until(self, day: int) -> Inspections:
        """Return the inspections up to the evening of a day."""
        return self.inspections.take(slice(0, np.searchsorted(self.days, day + 1)))

    def inspected(self, day: int) -> NDArray[np.int32]:
        """Return the plants inspected until the end of a day, some perhaps often."""
        done = self.until(day)
        plants: NDArray[np.int32] = done.plant[done.result != SKIPPED]
        return plants

    def night_after(self, morning: Belief, day: int) -> Belief:
        """Return what is believed the next morning, from what was on the morning of a day."""
        return self.evening(morning, day).overnight(self.night(day))

    def night(self, day: int) -> Spread:
        """Return what the insects are taken to do in the night after a day."""
        if self.pest_in_weather is None:
            return self.belief.spread
        return self.pest_in_weather.spread(day, self.grid.frame)

    def forecast(self, morning: Belief, day: int, nights: int = NIGHTS) -> Forecast:
        """Return how many plants are infested on the next mornings, nobody inspecting any more.

        By the weather measured or forecast, where there is any, and by the usual of the date after
        it.
        """
        ahead, known, measured = range(day, day + nights), None, 0
        if (pest := self.pest_in_weather) is not None and pest.weather is not None:
            known = sum(pest.known(number) for number in ahead)
            measured = sum(pest.measured(number) for number in ahead)
        evening, spreads = self.evening(morning, day), [self.night(number) for number in ahead]
        # what is flagged and not treated is still out there
        if (found := self.found_and_left(evening, day)) is None:
            now = self.estimate(morning, day)
        else:
            now = estimate_of(self.grid, self.in_hindsight(morning, day), found=found)
        made = forecast(evening, self.grid, spreads, known, now, found)
        return replace(made, measured=measured)

    def evening(self, morning: Belief, day: int) -> Belief:
        """Return what is believed after what was found and treated on a day."""
        # asked for by each layer of a day
        return self._last_evening.of(morning, day, self._evening)

    def in_hindsight(self, morning: Belief, day: int) -> Belief:
        """Return what to tell of the evening of a day: what its finds say of others counts too.

        The next morning it counts of itself, so that a night begins with `evening`.
        """
        # who infested whom is drawn for it
        return self._last_hindsight.of(morning, day, self._in_hindsight)

    def _in_hindsight(self, morning: Belief, day: int) -> Belief:
        return in_hindsight(self.evening(morning, day), self.night(day))

    @cached_property
    def _last_hindsight(self) -> _Last[Belief]:
        return _Last()

    @cached_property
    def _last_evening(self) -> _Last[Belief]:
        return _Last()

    def _evening(
        self, morning: Belief, day: int, later: NDArray[np.signedinteger] | None = None
    ) -> Belief:
        """Return what is believed after a day, and after inspections `later` in its work."""
        rows = self._rows_of(day)
        which = np.arange(rows.start, rows.stop)
        if later is not None:
            which = np.append(which, later)
        which = which[self.inspections.result[which] != SKIPPED]
        second = self.inspections.second[which] + np.where(self.days[which] > day, DAY_S, 0.0)
        today = [one for one in self.treatments if one.day == day]
        believed = morning
        for treatment in sorted(today, key=lambda one: one.second):
            # who was inspected without a time was so before it
            late = second > treatment.second
            believed = self._inspected(believed, which[~late])
            which, second = which[late], second[late]
            # who infested whom ends here: what it says of today's finds counts before
            believed = in_hindsight(believed, self.night(day)).treated(
                np.where(treatment.plants, 1 - treatment.efficacy, 1.0)
            )
        believed = self._inspected(believed, which)
        # its infestation is gone with it
        if (pulled := self.gone(day) & ~self.gone(day - 1)).any():
            left = np.where(pulled, 0.0, 1.0)
            believed = in_hindsight(believed, self.night(day)).treated(left)
        return believed

    def inspected_after(self, treatment: Treatment) -> NDArray[np.bool_]:
        """Return which of the inspections of a treatment's day count after it, ``(k,)``."""
        late: NDArray[np.bool_] = self.on(treatment.day).second > treatment.second
        return late

    def _inspected(self, believed: Belief, which: NDArray[np.signedinteger]) -> Belief:
        """Return what is believed after some inspections, in their order."""
        done, detection = self.inspections.take(which), self.detections[which]
        return self.belief.evening(believed, done.plant, done.result == FOUND, detection)

    def mean_detection(self, day: int) -> float:
        """Return what the inspections up to the evening of a day were told to find, on average.

        If there are none, what the first one after it was.
        """
        until = self.detections[: np.searchsorted(self.days, day + 1)]
        looked = self.inspections.result[: len(until)] != SKIPPED
        told = until[looked] if looked.any() else np.append(self.detections, self.detection)[:1]
        # the mean of equal numbers may be off in the last digit
        return float(told[0] if (told == told[0]).all() else told.mean())

    def estimate(self, morning: Belief, day: int) -> PlotEstimate:
        """Return how many plants are infested and not found yet, after a day's work."""
        # hundreds of fields are drawn for it
        return self._last_estimate.of(morning, day, self._estimate)

    def flagged(self, morning: Belief, day: int) -> float:
        """Return how many of the plants found are still infested after a day's work, as expected.

        They are found and not treated (`BeliefSettings.treated`), and so not in `estimate`.
        """
        if (flagged := self._flagged(day)) is None:
            return 0.0
        return float(self.in_hindsight(morning, day).chance[flagged].sum())

    def remember(self, morning: Belief, day: int, estimate: PlotEstimate) -> None:
        """Take this for what is estimated of a day: it was worked out from the same before."""
        flagged = self._flagged(day)
        found = 0 if flagged is None else int(np.count_nonzero(flagged))
        self._last_estimate.keep(morning, day, replace(estimate, found=found))

    @cached_property
    def _last_estimate(self) -> _Last[PlotEstimate]:
        return _Last()

    def _estimate(self, morning: Belief, day: int) -> PlotEstimate:
        return not_found_yet(self.grid, self.in_hindsight(morning, day), self._flagged(day))

    def infested(self, morning: Belief, day: int) -> PlotEstimate:
        """Return how many plants are infested after a day's work: not found yet, and flagged."""
        flagged = self._flagged(day)
        if flagged is None or not flagged.any():
            return self.estimate(morning, day)
        believed = self.in_hindsight(morning, day)
        if (believed.chance[flagged] > KNOWN).all():
            left = self.estimate(morning, day)
            return left.beside(left.found)
        return infested_in_all(self.grid, believed, flagged)

    def _flagged(self, day: int) -> NDArray[np.bool_] | None:
        """Return ``(n,)`` which plants there are that were found until a day; None: all treated."""
        return None if self.belief.treated else (self.states(day) == PRESENT) & ~self.gone(day)

    def found_and_left(self, evening: Belief, day: int) -> NDArray[np.bool_] | None:
        """Return the plants of which it is certain that they are infested; None: all are treated.

        A treatment leaves some of them in doubt, as all other plants.
        """
        return still_certain(evening, self._flagged(day))

    def level_range(self, morning: Belief, day: int) -> LevelRange:
        """Return how far the chances of plants not found yet may be off together, after a day."""
        return level_range(self._still_out(morning, day))

    def _still_out(self, morning: Belief, day: int) -> Belief:
        """Return what is believed of plants not found yet."""
        evening = self.in_hindsight(morning, day)
        if self.belief.treated:
            return evening
        # what was found is known: it is not out there any more
        return evening.treated(np.where(self.states(day) == PRESENT, 0.0, 1.0))

    def learnt(
        self, morning: Belief, day: int, detection: float | None = None
    ) -> tuple[Learnt, ...]:
        """Return what the inspections up to the evening of a day tell of the insects.

        And of inspections that are told to have a `detection`; None: of those made until then.
        """
        told = self.mean_detection(day) if detection is None else detection
        if np.all(self.until(day).result == SKIPPED):  # nights alone teach nothing
            return learnt_from(self.first_morning, told, self.night(day))
        learnt = learnt_from(self.in_hindsight(morning, day), told, self.night(day))
        if not learnt or self._ended_unfound(day):
            return learnt
        on = self.days[: len(self.until(day))][self.until(day).result != SKIPPED]
        ever = self._ever_infested(day, self.estimate(morning, day))
        since = np.count_nonzero(on > 0) / len(on)
        if on[0] > 0 or since > _HARDLY_FIRST:
            return with_start(learnt, ever)
        return with_start(learnt, ever, self._infested_first if day else ever, since)

    @cached_property
    def _infested_first(self) -> Estimate:
        """How many plants had been infested by the first evening."""
        evening = in_hindsight(self._evening(self.first_morning, 0), self.night(0))
        return self._ever_infested(0, not_found_yet(self.grid, evening, self._flagged(0)))

    def remember_first_evening(self, before: History) -> None:
        """Take over what was worked out of the first evening: it followed from the same before."""
        known = vars(before).get("_infested_first")
        if known is not None:
            vars(self)["_infested_first"] = known

    def _ever_infested(self, day: int, left: PlotEstimate) -> Estimate:
        """Return how many plants were infested by the evening of a day, if found or still so."""
        done = self.until(day)
        found = len(np.unique(done.plant[done.result == FOUND]))
        return Estimate(found + left.expected, found + left.low, found + left.high)

    def _ended_unfound(self, day: int) -> bool:
        """Tell whether infestations may have ended until a day that nobody found."""
        lives_in = self.pest_in_weather
        dies = lives_in is not None and lives_in.pest.mortality_per_day > 0.0
        return (
            (dies and day > 0)
            or any(one.day <= day for one in self.treatments)
            or bool(self.gone(day).any())
        )

    def first_find(self, on: date) -> date | None:
        """Return the day of the first find up to a date; None: there is none yet."""
        found = self.inspections.date[self.inspections.result == FOUND]
        found = found[found <= np.datetime64(on, "D")]
        return found.min().astype(object) if len(found) else None

    def last_inspected(self, day: int) -> NDArray[np.int32]:
        """Return ``(n,)`` the day of each plant's last inspection up to `day`, or `NEVER`."""
        last = np.full(len(self.grid), NEVER, np.int32)
        done = self.until(day)
        inspected = done.result != SKIPPED
        last[done.plant[inspected]] = self.days[: len(done)][inspected]
        return last

    def skips(self, day: int) -> Skips:
        """Return how often in a row each plant was skipped, up to the evening of a day."""
        done = self.until(day)
        skipped = (done.result == SKIPPED) & ~self.gone(day)[done.plant]
        days = self.days[: len(done)][skipped]
        return Skips.of(done.plant[skipped], days, self.last_inspected(day))

    @cached_property
    def says_gone(self) -> NDArray[np.bool_]:
        """Which inspections say that the plant does not stand there any more, ``(k,)``."""
        return say_gone(self.inspections)

    def gone(self, day: int) -> NDArray[np.bool_]:
        """Return ``(n,)`` which plants are gone by the evening of a day.

        They were said to be, and nobody inspected the place since.
        """
        until = np.searchsorted(self.days, day + 1)
        says = self.says_gone[:until]
        if not says.any():
            return np.zeros(len(self.grid), np.bool_)
        plant, at = self.inspections.plant[:until], np.arange(until)
        inspected = self.inspections.result[:until] != SKIPPED
        last, last_gone = np.full((2, len(self.grid)), -1)
        np.maximum.at(last, plant[inspected], at[inspected])
        np.maximum.at(last_gone, plant[says], at[says])
        is_gone: NDArray[np.bool_] = last_gone > last
        return is_gone

    def states(self, day: int) -> NDArray[np.int8]:
        """Return ``(n,)`` up to `day`: 1 found infested, 0 only looked clean, -1 never seen."""
        state = np.full(len(self.grid), -1, np.int8)
        done = self.until(day)
        inspected = done.result != SKIPPED
        np.maximum.at(state, done.plant[inspected], done.result[inspected])
        return state

    def known(self, day: int) -> NDArray[np.int8]:
        """Return ``(n,)`` the states up to `day` by inspections and by the records of before."""
        state = self.states(day)
        return state if self.recorded is None else np.maximum(state, self.recorded)

    def scene(
        self,
        shift: Shift,
        day: int,
        morning: Belief,
        now_s: float | None = None,
        who: str | Besides | None = None,
    ) -> Scene:
        """Return the scene of a day as it stands after what was recorded of it.

        Parameters
        ----------
        shift
            Who works, where, and from when on.
        day
            Number of the day.
        morning
            What was believed on its morning.
        now_s
            What time it is, see `ShiftWork.gone_s`.
        who
            Whose scene it is, of a team or beside others; None: all inspections were made by the
            one who works.
        """
        work = self.work(shift, who)
        later = work.past_midnight(day)
        # what the day's finds say of other plants counts for the rest of it, too
        now = (
            in_hindsight(self._evening(morning, day, later), self.night(day))
            if len(later)
            else self.in_hindsight(morning, day)
        )
        believed = in_sight(now)
        last = self.last_inspected(day)
        # nobody is sent to a plant twice a day, not even a closed one
        last[self.on(day).plant] = last[self.inspections.plant[later]] = day
        last[self.gone(day)] = day
        aisles, robot, today = shift.aisles, shift.robot, work.own(day)
        scene = Scene(
            aisles=aisles,
            robot=robot,
            # who is given a scene may write to it; the belief is kept for others
            chance=believed.chance.copy(),
            pair_chance=None if believed.pair_chance is None else believed.pair_chance.copy(),
            traces=believed.traces,
            last_inspected=last,
            day=day,
            at=int(today.plant[-1]) if len(today) else work.resting(day),
            seconds_left=max(0.0, robot.day_s - work.gone_s(day, now_s)),
            trail=work.trail(day),
            key=shift.streams.key("sampler", day),
            infested=None if believed is now else now.chance.copy(),
        )
        known = without_flagged(scene, self.found_and_left(now, day))
        return without_skipped(known, self.skips(day - 1))

    def work(self, shift: Shift, who: str | Besides | None = None) -> ShiftWork:
        """Return the work of a shift, day by day; `who` is that of `scene`."""
        # asked for several times by each day
        key = shift.aisles, shift.robot, shift.starts_s, who
        if key not in self._works:
            clock = grid_clock(self.grid)
            self._works[key] = ShiftWork(
                shift, who, self.begins, clock, self.inspections, self.days
            )
        return self._works[key]

    @cached_property
    def _works(self) -> dict[Hashable, ShiftWork]:
        return {}


def say_gone(inspections: Inspections) -> NDArray[np.bool_]:
    """Return ``(k,)`` which inspections say that the plant does not stand there any more."""
    gone: NDArray[np.bool_] = inspections.result == SKIPPED
    gone[gone] = [says_gone(str(note)) for note in inspections.notes[gone]]
    return gone
