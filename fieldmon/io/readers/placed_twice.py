"""Records that give a position and name a plant, too: what to say where the two disagree."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from fieldmon.compute.units import distance_figure
from fieldmon.compute.wording import first_few, joined, worded
from fieldmon.errors import FieldmonError
from fieldmon.infestation.prior.prior_settings import PriorSettings
from fieldmon.io.formats.layer import Layer, text
from fieldmon.io.import_report import ImportMessage, Remedy, Severity, doubtful
from fieldmon.io.options import RecordOptions
from fieldmon.io.parse.columns import find, plain
from fieldmon.io.parse.named_positions import placed_by_name
from fieldmon.io.parse.values import is_missing
from fieldmon.plot.plants_outside import distance_m
from fieldmon.plot.projection import M_PER_DEGREE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.compute.wording import Worded
    from fieldmon.io.parse.positions import LocatedFeatures
    from fieldmon.io.readers.places import NamedPlaces
    from fieldmon.plot.field import Field

    Float = NDArray[np.float64]

# a plant is another one where it is so many times the accuracy from the position, and a spacing
_SIGMAS = 4.0
# where most disagree, and not just a few, rows are counted otherwise
_FEW = 3


@dataclass(frozen=True, eq=False)
class PlacedTwice(ImportMessage):
    """What is said of records that give a position and name a plant, too.

    Parameters
    ----------
    names
        The columns that name plots, blocks, rows and plants, of these ``m`` records.
    lonlat
        ``(m, 2)`` degrees.
    accuracy_m
        ``(m,)`` of the position; NaN where it is not known.
    options
        With which they were read.
    """

    names: Layer = field(default_factory=lambda: Layer("", {}))
    lonlat: Float = field(default_factory=lambda: np.empty((0, 2)))
    accuracy_m: Float = field(default_factory=lambda: np.empty(0))
    options: RecordOptions = field(default_factory=RecordOptions)

    def on(self, plot: Field) -> PlacedTwice:
        """Return what is said of those that lie on a plot: what lies beside it may be another's."""
        here = distance_m(self.lonlat, plot) <= 0.0
        return replace(
            self,
            names=self.names.take(here),
            lonlat=self.lonlat[here],
            accuracy_m=self.accuracy_m[here],
        )

    @property
    def plots(self) -> tuple[str, ...]:
        """Return the plots that they name, perhaps none."""
        return tuple(sorted({*self._plot_names().tolist()} - {""}))

    def _plot_names(self) -> NDArray[np.str_]:
        """Return the plot that each names ``(m,)``, empty where it names none."""
        told = self.options.column("plot")
        column = find("plot", self.names.columns) if told is None else told
        cells = self.names.column(column) if column else [""] * len(self.lonlat)
        return np.array([text(cell) for cell in cells], np.str_)

    def on_wrong_plots(
        self, plot: Field, every: tuple[Field, ...], spacing_m: float
    ) -> list[ImportMessage]:
        """Return a doubt where those on a plot name another one, and where its own lie on another.

        None where it was said what counts. `every` are the plots of the plot's file.
        """
        others = {plain(one.name): one for one in every if one.name != plot.name}
        names = np.array([plain(one) for one in self._plot_names().tolist()], np.str_)
        if self.options.place is not None or not others:
            return []
        allowed_m = spacing_m + _SIGMAS * self._own_m()
        away_m = distance_m(self.lonlat, plot)
        gone = np.flatnonzero((names == plain(plot.name)) & (away_m > allowed_m))
        return [
            *self._about_strangers(plot, others, (names, away_m <= 0.0, allowed_m)),
            *self._about_lost(plot, list(others.values()), gone),
        ]

    def _about_strangers(
        self,
        plot: Field,
        others: dict[str, Field],
        records: tuple[NDArray[np.str_], NDArray[np.bool_], NDArray[np.float64]],
    ) -> list[ImportMessage]:
        """Return a doubt where records on a plot name another one, away from that.

        `others` by their plain names; of each record the plot's plain name, whether it lies on
        `plot`, and how far from its own it may lie, metres.
        """
        names, is_on, allowed_m = records
        here = np.flatnonzero(is_on & np.isin(names, list(others)))
        strangers = np.zeros(len(names), np.bool_)
        for name in np.unique(names[here]).tolist():
            mine = here[names[here] == name]
            from_own_m = distance_m(self.lonlat[mine], others[name])
            strangers[mine] = from_own_m > allowed_m[mine]
        if not strangers.any():
            return []
        own = sorted(others[name].name for name in np.unique(names[strangers]).tolist())
        sentence = worded(
            "{n} {n:record lies|records lie} on {plot}, but {n:names|name} {n:a plant|plants} "
            "of {others}, {example}. {n:Its position was|Their positions were} taken: look "
            "which is right.",
            n=int(np.count_nonzero(strangers)),
            plot=plot.name,
            others=first_few(own),
            example=self._first(int(np.argmax(strangers))),
        )
        return [doubtful(sentence, remedy=_by_plant())]

    def _about_lost(
        self, plot: Field, others: list[Field], gone: NDArray[np.intp]
    ) -> list[ImportMessage]:
        """Return a doubt where records that name a plot and lie away from it lie on another."""
        tree = shapely.STRtree([one.boundary for one in others])
        record, other = tree.query(shapely.points(self.lonlat[gone]), predicate="intersects")
        lost = np.unique(gone[record])
        if not len(lost):
            return []
        on = sorted({others[k].name for k in other.tolist()})
        sentence = worded(
            "{n} {n:record names|records name} {n:a plant|plants} of {plot}, but {n:lies|lie} "
            "on {others}, {example}. {n:Its position was|Their positions were} taken: look "
            "which is right.",
            n=len(lost),
            plot=plot.name,
            others=first_few(on),
            example=self._first(int(lost[0])),
        )
        return [doubtful(sentence, remedy=_by_plant())]

    def _first(self, record: int) -> Worded:
        """Return which plant the first of some records names."""
        row, plant = self._called(record)
        if row is None:
            return worded("the first plant {plant}", plant=plant)
        return worded("the first row {row}, plant {plant}", row=row, plant=plant)

    def _own_m(self) -> Float:
        """Return the accuracy of each position ``(m,)``, the usual one where none is stated."""
        usual_m = PriorSettings().accuracy_m
        own_m: Float = np.where(np.isnan(self.accuracy_m), usual_m, self.accuracy_m)
        return own_m

    def doubts(self, places: NamedPlaces, spacing_m: float) -> list[ImportMessage]:
        """Return a doubt where they lie elsewhere than the plants of a plot that they name.

        A spacing away, the greatest of these plants, one is as good as the next. None where it
        was said what counts, nor where they name no plants of it.
        """
        if self.options.place is not None:
            return []
        try:
            named = placed_by_name(self.names, self.options, places)
        except FieldmonError:  # it is not known what their names mean here
            return []
        away_m = _away_m(named.lonlat, self.lonlat)
        elsewhere = away_m > spacing_m + _SIGMAS * self._own_m()
        n, n_known = (int(np.count_nonzero(one)) for one in (elsewhere, np.isfinite(away_m)))
        if not n:
            return []
        worst = int(np.argmax(np.where(elsewhere, away_m, -1.0)))
        said = worded(
            "{n} of {all} records that give a position and name a plant {n:lies|lie} elsewhere "
            "than that plant, {example}. {n:Its position was|Their positions were} taken: look "
            "which is right.",
            n=n,
            all=n_known,
            example=self._example(worst, float(away_m[worst])),
        )
        if n > _FEW and 2 * n > n_known:
            other = worded("The file may count rows or plants otherwise than this plot does.")
            said = joined(" ", [said, other])
        return [doubtful(said, remedy=_by_plant())]

    def _called(self, record: int) -> tuple[str | None, str | None]:
        """Return the row and the plant that a record names."""
        row, plant = (
            None if column is None else text(self.names.column(column)[record])
            for column in _columns(self.names, self.options)
        )
        return row, plant

    def _example(self, record: int, away_m: float) -> Worded:
        """Return which plant a record names, and how far it lies from it."""
        row, plant = self._called(record)
        away = distance_figure(away_m)
        if row is None:
            return worded("the farthest {away} from plant {plant}", plant=plant, away=away)
        return worded(
            "the farthest {away} from row {row}, plant {plant}", row=row, plant=plant, away=away
        )


def _by_plant() -> Remedy:
    return Remedy("place", "plant", worded("Take the plants that they name"), ("position",))


def placed_twice(
    found: LocatedFeatures, accuracy_m: Float, options: RecordOptions
) -> tuple[PlacedTwice, ...]:
    """Return what is said of records that were placed by position and name a plant, too."""
    layer = found.layer
    row, plant = _columns(layer, options)
    if found.by_name or plant is None:
        return ()
    named = [column for column in (row, plant) if column is not None]
    both = np.ones(len(layer), np.bool_)
    for column in named:
        both &= [not is_missing(value) for value in layer.column(column)]
    if not both.any():
        return ()
    roles = (options.column(r) or find(r, layer.columns) for r in ("plot", "block"))
    columns = {*named, *(one for one in roles if one)}
    names = Layer(layer.name, {one: layer.column(one)[both] for one in layer.columns
                               if one in columns})  # fmt: skip
    said = worded(
        "{n} {n:record gives a position and names|records give positions and name} a plant, too: "
        "{n:its position was|their positions were} taken.",
        n=int(np.count_nonzero(both)),
    )
    return (
        PlacedTwice(
            Severity.SEEN,
            said,
            names=names,
            lonlat=found.lonlat[both],
            accuracy_m=accuracy_m[both],
            options=options,
        ),
    )


def _columns(layer: Layer, options: RecordOptions) -> tuple[str | None, str | None]:
    """Return the columns of rows and of plants, as `placed_by_name` finds them."""
    row = options.column("row") or find("row", layer.columns)
    taken = frozenset({row} if row else ())
    return row, options.column("plant") or find("plant", layer.columns, taken)


def _away_m(one: Float, other: Float) -> Float:
    """Return how far positions ``(m, 2)`` are apart, NaN where one is not known."""
    off_deg = one - other
    off_deg[:, 0] = (off_deg[:, 0] + 180.0) % 360.0 - 180.0
    off_deg[:, 0] *= np.cos(np.radians(one[:, 1]))
    away_m: Float = np.hypot(*off_deg.T) * M_PER_DEGREE
    return away_m
