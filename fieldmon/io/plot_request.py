"""What a plot is prepared from: its files, how they are read, and what is said of its rows."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeAlias

from fieldmon.compute.kinds import must_hold_kinds
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.plot.planting import Planting

if TYPE_CHECKING:
    from fieldmon.infestation.prior.raster_risk import RiskSettings
    from fieldmon.io.options import Source
    from fieldmon.io.rasters.values import How, RasterOptions

#: what a file is to a plot
Role: TypeAlias = Literal[
    "plot", "plants", "rows", "blocks", "contours", "paths", "records", "canopy", "risk"
]


@dataclass(frozen=True)
class PlotSources:
    """The files of a plot, and where one gets in.

    Parameters
    ----------
    plot
        File of plots; None: the plot is where its measured plants are, or its rows.
    plot_options
        How it is read; ``feature`` says which of its plots is meant, if it holds several.
    plants, plants_options
        File of positions of plants measured on the plot.
    paths, paths_options
        File of lines along which insects enter.
    gate
        ``(lon, lat)`` where the day starts and ends.
    rows, rows_options
        File of rows: as lines, or as their end posts, two a row. All others are copies of a
        single one.
    contours, contours_options
        Raster of heights: rows run along its contours.
    blocks, blocks_options
        File of blocks as areas, or of the lines that part a plot into blocks.
    guess_blocks
        Part a plot into blocks where its outline asks for rows in several directions.
    """

    plot: Source | None = None
    plot_options: PlotOptions = field(default_factory=PlotOptions)
    plants: Source | None = None
    plants_options: ReadOptions = field(default_factory=ReadOptions)
    paths: Source | None = None
    paths_options: ReadOptions = field(default_factory=ReadOptions)
    gate: tuple[float, float] | None = None
    rows: Source | None = None
    rows_options: ReadOptions = field(default_factory=ReadOptions)
    contours: Source | None = None
    contours_options: RasterOptions | None = None
    blocks: Source | None = None
    blocks_options: PlotOptions = field(default_factory=PlotOptions)
    guess_blocks: bool = False

    @property
    def first(self) -> Role:
        """Return which of the files says where the plot is."""
        roles: tuple[Role, ...] = ("plot", "plants")
        return next((role for role in roles if getattr(self, role) is not None), "rows")


@dataclass(frozen=True)
class PlantingChoices:
    """What is said of a plot's rows by hand, as `Planting` has it; None: found, stated or usual.

    Parameters
    ----------
    row_bearing_deg
        Direction of the rows, degrees clockwise from true north.
    row_spacing_m, plant_spacing_m
        From row to row, and from plant to plant in a row.
    headland_m
        Free of plants at both ends of each row.
    faces
        How many faces of a row are inspected, 1 or 2.
    half_canopy_m
        How far plants reach to each side of their middle.
    in_rows
        False for measured plants that stand in no rows, and are visited by nearness.

    Examples
    --------
    >>> import fieldmon as fm
    >>> choices = fm.PlantingChoices(row_spacing_m=5.0)
    >>> fm.read_plot("sample_data/paran_estate.zip", feature="Gate", planting=choices)
    <Plot Gate: 3,060 plants in 36 rows>
    """

    row_bearing_deg: float | None = None
    row_spacing_m: float | None = None
    plant_spacing_m: float | None = None
    headland_m: float | None = None
    faces: int | None = None
    half_canopy_m: float | None = None
    in_rows: bool = True

    def __post_init__(self) -> None:
        must_hold_kinds(self, "Planting choices'")
        Planting(**self.given())  # type: ignore[arg-type]

    def given(self) -> dict[str, float]:
        """Return what is said of a planting in rows, by name."""
        said = {name: value for name, value in vars(self).items() if value is not None}
        del said["in_rows"]
        return said


@dataclass(frozen=True)
class RecordSource:
    """A file of dated pest records; they give positions, or name rows and plants, or plots."""

    file: Source
    options: RecordOptions = field(default_factory=RecordOptions)


@dataclass(frozen=True)
class CanopySource:
    """A raster that shows where plants are missing.

    Parameters
    ----------
    file
        The raster.
    below
        No plant stands where it has less than this.
    options
        How it is read; None: as it says.
    how
        What of a plant's ground counts; None: the highest.
    """

    file: Source
    below: float
    options: RasterOptions | None = None
    how: How | None = None


@dataclass(frozen=True)
class RiskSource:
    """A raster of the risk of infestation.

    Parameters
    ----------
    file
        The raster.
    settings
        What its numbers mean; None: as the file says, else it is asked.
    options
        How it is read; None: as it says.
    how
        What of a plant's ground counts; None: the mean.
    """

    file: Source
    settings: RiskSettings | None = None
    options: RasterOptions | None = None
    how: How | None = None


@dataclass(frozen=True)
class PlotRequest:
    """All that a plot is prepared from; see `fieldmon.io.prepare`."""

    sources: PlotSources
    planting: PlantingChoices = field(default_factory=PlantingChoices)
    records: RecordSource | None = None
    canopy: CanopySource | None = None
    risk: RiskSource | None = None
