"""A monitoring season that grows day by day, kept in one GeoPackage."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.arguments import must_be_language, must_have_its_name
from fieldmon.compute.array_arguments import array_of_plants
from fieldmon.compute.kinds import checked
from fieldmon.compute.wording import worded
from fieldmon.errors import FileProblem, SettingError
from fieldmon.infestation.prior.prior import prior_chance
from fieldmon.infestation.records import Records
from fieldmon.io.readers.nearby import warn_of_left_out
from fieldmon.monitoring.changes import season_log
from fieldmon.monitoring.changes.file_revision import FileRevision
from fieldmon.monitoring.changes.transactions import Store, set_meta
from fieldmon.monitoring.estimates import derived_layers, first_morning
from fieldmon.monitoring.estimates.mornings import Mornings
from fieldmon.monitoring.estimates.season_contents import SeasonContents, nothing_yet
from fieldmon.monitoring.estimates.verifying import changed_maps, check_against_log
from fieldmon.monitoring.file import qgis_project, tables
from fieldmon.monitoring.file.connections import kept_open
from fieldmon.monitoring.phones.people import written_in
from fieldmon.monitoring.season.season_frames import SeasonFrames
from fieldmon.monitoring.season.season_plans import SeasonPlans
from fieldmon.monitoring.settings import settings_log, settings_words
from fieldmon.monitoring.settings.belief_settings import BeliefSettings
from fieldmon.monitoring.settings.settings import (
    MonitoringSettings,
    as_json,
    settings_from,
)
from fieldmon.monitoring.settings.settings_log import settings_of
from fieldmon.planning.assumptions import assumed_by, assumed_by_team
from fieldmon.planning.members import refuse_far_gates, refuse_too_wide, ways_of
from fieldmon.plot.assumed import Assumed
from fieldmon.plot.local_clock import local_clock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable
    from datetime import date

    from numpy.typing import NDArray

    from fieldmon.monitoring.file.tables import KeptMessage
    from fieldmon.plot.plot import Plot
    from fieldmon.plot.robot import Robot

    Floats = NDArray[np.float64]


@checked
class Season(SeasonPlans, SeasonFrames):
    """A season on disk. Begin one with `create`, come back to it with ``Season(path)``.

    Each call reads what is new in the file before it answers, and what it writes is one
    transaction: windows and programs can work on the same season at once.

    Raises
    ------
    FileProblem
        If the file is missing, damaged, of a newer version, or held by another program.

    Examples
    --------
    >>> from datetime import date
    >>> import fieldmon as fm, numpy as np
    >>> plot = fm.read_plot("sample_data/paran_estate.zip", feature="Gate")
    >>> season = fm.Season.create("season.gpkg", plot, begins=date(2026, 11, 18))
    >>> today = season.plan(date(2026, 11, 18))
    >>> found = np.zeros(2, np.int8)
    >>> seen = fm.Inspections.of(today.route.plant[:2], found, np.datetime64("2026-11-18"))
    >>> _ = season.record(seen)
    >>> len(fm.Season("season.gpkg").history.inspections)
    2
    """

    @kept_open()
    def __init__(self, path: str | Path) -> None:
        super().__init__(path)
        #: findings that another program added to the file, and why some of them do not count
        self.drafts = self.take_drafts()

    def __repr__(self) -> str:
        """Say which file and which plot."""
        return f"<Season {self.path.name}: {self.plot!r}>"

    @classmethod
    def create(
        cls,
        path: str | Path,
        plot: Plot,
        records: Records | None = None,
        settings: MonitoringSettings | None = None,
        messages: Iterable[KeptMessage] | None = None,
        risk: Any = None,  # noqa: ANN401 - held to its kind below
        **chosen: Any,  # noqa: ANN401 - fields of the settings
    ) -> Season:
        """Begin a season in a new file, whole or not at all.

        Parameters
        ----------
        path
            The file, a GeoPackage; it must not exist.
        plot
            Plants and the ways between them.
        records
            Records from before; None: none.
        settings
            What is chosen; None: the defaults, from today on in the plot's time zone.
        messages
            What imports had to say, to be kept; None: nothing, and `ImportDoubt` warns of records
            that are left out.
        risk
            ``(n,)`` one more chance of being infested at the start, from a raster for instance,
            see `fieldmon.infestation.prior.prior.prior_chance`; None: none. Of pandas its index
            must be the plants', 0, 1, 2...
        chosen
            Settings one by one instead, as ``begins=date(2026, 11, 18)`` or
            ``robot=Robot(hours=4)``. A time that names a zone is its day on the plot.

        Raises
        ------
        FileProblem
            If the file exists, or cannot be written.
        SettingError
            If what is handed over is something else or cannot be worked with, or an earlier season
            did not end before.
        """
        settings = _chosen_for(plot, settings, chosen)
        if records is None:
            records = Records.none()
        begins = np.datetime64(settings.begins, "D")
        if messages is None:
            warn_of_left_out(records, begins, plot.field)
        if risk is not None:
            risk = array_of_plants(np.float64, "A risk map", risk)
        prior = prior_chance(plot.grid, plot.field, records, begins, settings.prior, risk)
        told = settings.robot.detects
        history = nothing_yet(plot, settings, prior, records, told)
        first = SeasonContents(FileRevision(0, 0), settings, history, Mornings(history))
        with Store.new(path) as db:
            tables.write_plot(db, plot)
            tables.write_records(db, records)
            tables.write_messages(db, () if messages is None else messages)
            if risk is not None:
                tables.write_array(db, "risk", risk)
            settings_log.write(db, as_json(settings))
            set_meta(db, "revision", "0")
            # whoever opens it need not work it out again
            first_morning.keep(db, first_morning.causes(db, settings.begins, settings.prior), prior)
            derived_layers.refresh(db, plot, history, first.morning)
            qgis_project.keep(db, Path(path).name)
            season_log.begin(db, f"a season on {plot.field.name}")
        return cls(path)

    def assumed(self, settings: MonitoringSettings | None = None) -> tuple[Assumed, ...]:
        """Return what the season's figures rest on though nobody said it.

        `settings` are those that count, as of an earlier day; None: those of now.
        """
        settings = settings or self.settings
        laid, prior = self.plot.assumed, settings.prior
        if settings.team:
            made = assumed_by_team(laid, prior, settings.team, self.plot.grid)
        else:
            made = assumed_by(laid, prior, settings.robot, self.plot.grid)
        rate, usual = settings.belief.spread.rate_per_day, BeliefSettings()
        if settings.pest is not None:
            made = (*made, *settings.pest.assumed)
        elif rate == usual.spread.rate_per_day:
            made = (*made, Assumed("rate_per_day", rate))
        if settings.belief.treated == usual.treated:
            made = (*made, Assumed("treated", 1.0))
        return made

    def change(self, settings: MonitoringSettings, seen: MonitoringSettings, who: str = "") -> None:
        """Choose otherwise.

        Parameters
        ----------
        settings
            What counts from now on.
        seen
            What counted when it was chosen.
        who
            Who changes it, for the log.

        Raises
        ------
        FileProblem
            If something else than `seen` counts by now.
        SettingError
            If nobody could work so, or the season is to begin on another day though
            something was recorded or planned.
        """
        settings = settings.of_its_pest(seen)
        _must_work(settings, self.plot, seen)
        with self._lock, self.store.writing() as db:
            if as_json(settings_of(db)) != as_json(seen):
                raise FileProblem(
                    worded(
                        "The season's settings must be as they were when you looked, but another "
                        "window changed them. Look again and repeat your change."
                    )
                )
            _refuse_other_days(db, seen.begins, settings.begins)
            before = settings_log.as_written_now(settings_log.now(db))
            settings_log.change(db, settings)
            self._log_change(db, before, who)
            self._refresh(db)

    def undo_change(self, who: str = "") -> MonitoringSettings:
        """Take the last change of settings back; return what counts again. `who` is for the log.

        Raise `SettingError` if there is none, or as `change` does.
        """
        with self._lock, self.store.writing() as db:
            before, seen = settings_log.as_written_now(settings_log.now(db)), settings_of(db)
            settings = settings_log.undo(db)
            _must_work(settings, self.plot, seen)
            _refuse_other_days(db, seen.begins, settings.begins)
            self._log_change(db, before, who, back=True)
            self._refresh(db)
        return settings

    def _log_change(
        self, db: sqlite3.Connection, before: settings_log.Parts, who: str, *, back: bool = False
    ) -> None:
        now = settings_log.as_written_now(settings_log.now(db))
        names = [name for name in now if now[name] != before.get(name)]
        season_log.append(
            db, "changed", written_in(db, who),
            states={"settings": season_log.settings_state(db)},
            names=", ".join(names), now={name: now[name] for name in names},
            said="; ".join(settings_words.differences(before, now)),
            **({"back": True} if back else {}),
        )  # fmt: skip

    @kept_open()
    def verify(self, *, whole: bool = True) -> tuple[str, ...]:
        """Hold the file to its digests; return a sentence for each thing that differs.

        And for what its pest says otherwise, though nobody chose it.

        If `whole`, every morning since the first is worked out again and each row is held to the
        log; else only the last morning that the file keeps, and those after it.
        """
        doubt = () if self.store.doubt is None else (self.store.doubt,)
        doubt = (*doubt, *self.settings.unlike_its_pest())
        held = check_against_log(self) if whole else ()
        return (*doubt, *held, *changed_maps(self, whole=whole))

    def rebuild(self, *, whole: bool = True) -> None:
        """Write the layers that follow from the causes anew.

        If `whole`, from the first day on; else from the last morning that still follows from all
        before it.
        """
        with self._lock, self.store.writing() as db:
            self._refresh(db, 0 if whole else None)


def _chosen_for(
    plot: Plot, settings: MonitoringSettings | None, chosen: dict[str, Any]
) -> MonitoringSettings:
    """Return the settings of a new season, given as one or one by one; raise if none can be."""
    must_have_its_name("A season's records", chosen, "observations", "records")
    if settings is None:
        clock = local_clock(plot.field)
        settings = settings_from({"begins": clock.today()} | chosen, clock.at)
    elif chosen:
        raise SettingError(
            worded(
                "A season's settings must be given as one or one by one, but beside settings "
                "there is {names}. Put it into them: dataclasses.replace(settings, ...).",
                names=", ".join(chosen),
            )
        )
    settings = settings.of_its_pest()
    _must_work(settings, plot)
    if settings.belief.earlier is not None:
        settings.belief.earlier.must_end_before(settings.begins)
    return settings


def _must_work(
    settings: MonitoringSettings, plot: Plot, before: MonitoringSettings | None = None
) -> None:
    """Raise `SettingError` unless a season on a plot can be worked so; what was so `before` may."""
    settings.must_detect()
    if settings.language and (before is None or settings.language != before.language):
        must_be_language(settings.language)
    gates = set() if before is None else {one.gate for one in before.team}
    refuse_far_gates((one for one in settings.team if one.gate not in gates), plot.field)
    driven = [] if before is None else [one.robot for one in before.team] or [before.robot]
    sizes = {_size(robot) for robot in driven}
    refuse_too_wide((one for one in settings.team if _size(one.robot) not in sizes), plot)
    if not settings.team and _size(settings.robot) not in sizes:
        ways_of(settings.robot, plot.aisles)


def _size(robot: Robot) -> tuple[float | None, ...]:
    return robot.width_m, robot.length_m, robot.turning_radius_m


def _refuse_other_days(db: sqlite3.Connection, begins: date, instead: date) -> None:
    """Raise `SettingError` if days are to be counted from another one though some were worked."""
    used = "SELECT 1 FROM batches UNION ALL SELECT 1 FROM routes LIMIT 1"
    if begins != instead and db.execute(used).fetchone() is not None:
        raise SettingError(
            worded(
                "A season must begin when it began, on {begins}, once something was recorded or "
                "planned: its days are counted from then. But it was to begin on {instead}. Begin "
                "a new season, and record there what was found.",
                begins=begins,
                instead=instead,
            )
        )
