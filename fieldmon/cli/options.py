"""Options that commands share, and what is made of them. Heavy imports wait."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldmon.cli.named_values import Options, chosen, chosen_of_file
from fieldmon.cli.option_ranges import within
from fieldmon.cli.raster_options import RasterFiles
from fieldmon.compute.ranges import CHANCE, DAYS, SEED, SHARE
from fieldmon.errors import SettingError
from fieldmon.io.formats.signatures import USUAL_FILES
from fieldmon.plot.planting import PLANTED
from fieldmon.samplers import EVERY, SAMPLERS, kind_of, sampler_with
from fieldmon.samplers.own import is_own

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldmon.io.options import PlotOptions
    from fieldmon.io.plot_request import PlantingChoices, PlotRequest, PlotSources
    from fieldmon.io.rasters.values import RasterOptions
    from fieldmon.samplers.base import Sampler

PLOT_HELP = f"Plot file: shapefile (.shp or .zip), {', '.join(USUAL_FILES)}, ..."

PlotFile = Annotated[Path, typer.Argument(help=PLOT_HELP, show_default=False)]
MaybePlotFile = Annotated[
    Path | None,
    typer.Argument(help=f"{PLOT_HELP} Not needed if --plants or --rows are.", show_default=False),
]
SeasonFile = Annotated[Path, typer.Argument(help="The season's file, made by fieldmon init.")]
Feature = Annotated[
    str | None,
    typer.Option(help="Name or number (from 1) of the plot, if the file holds several."),
]
PlotChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--plot-option",
        help="What else the plot file does not say, as NAME=VALUE; messages ask for it. "
        "E.g. crs=EPSG:2039, layer=parcels, member=plots.shp, swap_axes=yes.",
    ),
]
Crs = Annotated[
    str | None, typer.Option(help="Coordinate system of the plot file if it has none: EPSG:2039.")
]
Layer = Annotated[str | None, typer.Option(help="Layer of the plot file.")]
RecordsFile = Annotated[
    Path | None,
    typer.Option(help="Dated pest records: CSV, Excel, shapefile, GeoJSON, ..."),
]
RecordChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--record-option",
        help="What the records do not say, as NAME=VALUE: crs=EPSG:2039, date_order=dmy, "
        "columns=date=Datum, columns=count=Milben, found=WORD,WORD, clean=WORD, degrees=dms, "
        "place=plant.",
    ),
]
Plants = Annotated[
    Path | None, typer.Option(help="Positions of plants measured on the plot (points).")
]
Paths = Annotated[
    Path | None, typer.Option(help="Paths and roads from which insects enter (lines).")
]
PlantsChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--plants-option", help="What the file of plants does not say, as NAME=VALUE: doubles=one."
    ),
]
PathsChoices = Annotated[
    list[str] | None,
    typer.Option("--paths-option", help="What the file of paths does not say, as NAME=VALUE."),
]
Rows = Annotated[
    Path | None,
    typer.Option(help="Rows of plants as lines, or their end posts as points, two per row."),
]
RowsChoices = Annotated[
    list[str] | None,
    typer.Option("--rows-option", help="What the file of rows does not say, as NAME=VALUE."),
]
Blocks = Annotated[
    Path | None,
    typer.Option(help="Blocks with rows of their own: areas, or lines that divide the plot."),
]
BlocksChoices = Annotated[
    list[str] | None,
    typer.Option("--blocks-option", help="What the file of blocks does not say, as NAME=VALUE."),
]
GuessBlocks = Annotated[
    bool,
    typer.Option(
        "--guess-blocks", help="Guess blocks if the outline suggests rows in several directions."
    ),
]
Contours = Annotated[
    Path | None,
    typer.Option(help="GeoTIFF of heights: rows run along its contours, as on terraces."),
]
ContoursChoices = Annotated[
    list[str] | None,
    typer.Option(
        "--contours-option", help="How heights are read, as NAME=VALUE: band, crs, nodata, member."
    ),
]
Bearing = Annotated[
    float | None,
    typer.Option(
        help="Direction of the rows, degrees from north; found if not given.",
        callback=within(PLANTED["row_bearing_deg"]),
    ),
]
RowSpacing = Annotated[
    float | None,
    typer.Option(help="Metres from row to row.", callback=within(PLANTED["row_spacing_m"])),
]
PlantSpacing = Annotated[
    float | None,
    typer.Option(
        help="Metres from plant to plant in a row.", callback=within(PLANTED["plant_spacing_m"])
    ),
]
Headland = Annotated[
    float | None,
    typer.Option(
        help="Metres without plants at both row ends.", callback=within(PLANTED["headland_m"])
    ),
]
HalfCanopy = Annotated[
    float | None,
    typer.Option(
        help="Metres that plants reach to each side of their middle; for --width.",
        callback=within(PLANTED["half_canopy_m"]),
    ),
]
BothFaces = Annotated[
    bool, typer.Option("--both-faces", help="Inspect both faces of each row, each from its aisle.")
]
NoRows = Annotated[
    bool,
    typer.Option("--no-rows", help="Measured plants do not stand in rows: visit them by distance."),
]
Gate = Annotated[str | None, typer.Option(help="Where the day starts and ends: LON,LAT.")]


def _usual_n(*, of_share: bool) -> str:
    """Return the samplers that take an N, of every N-th or of a share, each with its own."""
    having = [(name, kind) for name, kind in SAMPLERS.items() if kind.every is not None]
    return ", ".join(f"{name} {of.every}" for name, of in having if of.draws_share == of_share)


Every = Annotated[
    int | None,
    typer.Option(
        help=f"Every N-th plant or stop ({_usual_n(of_share=False)}) or 1/N "
        f"({_usual_n(of_share=True)}).",
        callback=within(EVERY),
    ),
]
Outputs = Annotated[
    list[Path] | None,
    typer.Option(
        "--output",
        "-o",
        help="Route file to write; its ending selects the format. Repeat for several. "
        "Default: route.geojson.",
    ),
]
Bounded = Annotated[
    bool,
    typer.Option(
        "--bound/--no-bound",
        help="State what no other route of these hours can expect to find (takes 10 s at most).",
    ),
]
WorkDate = Annotated[
    str | None, typer.Option("--date", help="Day of the work, YYYY-MM-DD; default: today.")
]
TheDate = Annotated[str | None, typer.Option("--date", help="The day, YYYY-MM-DD; default: today.")]
LastDate = Annotated[
    str | None,
    typer.Option(
        "--date", help="The day, YYYY-MM-DD; else the last planned or recorded, today at most."
    ),
]
SeasonDays = Annotated[int, typer.Option(help="Days of a season.", callback=within(DAYS))]
VisitEvery = Annotated[
    int,
    typer.Option(
        help="Days from one visit to the next, the first on day 1; between visits nobody inspects.",
        callback=within(DAYS),
    ),
]
InfestedAtStart = Annotated[
    float, typer.Option(help="Share of plants infested at the start.", callback=within(SHARE))
]
Background = Annotated[
    float | None,
    typer.Option(
        help="Chance of a plant of which nothing is known, far from edges and paths: 0.01 unless "
        "said. Give what is usual in the region.",
        callback=within(CHANCE),
    ),
]
StudySeed = Annotated[
    int, typer.Option(help="Seed; the same seed gives the same figures.", callback=within(SEED))
]
MoveMinutes = Annotated[
    float,
    typer.Option(
        "--move",
        help="Minutes from one plot to the next.",
        callback=within(0, 120, unit=" minutes"),
    ),
]
StartTime = Annotated[str, typer.Option(help="Local time at which work starts, HH:MM.")]


@dataclass(frozen=True)
class RowOptions:
    """How the plot is planted."""

    bearing: Bearing = None
    row_spacing: RowSpacing = None
    plant_spacing: PlantSpacing = None
    headland: Headland = None
    half_canopy: HalfCanopy = None
    both_faces: BothFaces = False
    no_rows: NoRows = False

    def choices(self) -> PlantingChoices:
        """Return what was said of the rows."""
        from fieldmon.io.plot_request import PlantingChoices

        faces = 2 if self.both_faces else None
        spacings = self.row_spacing, self.plant_spacing, self.headland
        in_rows = not self.no_rows
        return PlantingChoices(self.bearing, *spacings, faces, self.half_canopy, in_rows)


@dataclass(frozen=True)
class FileOptions:
    """The files about a plot, and how each is read."""

    gate: Gate = None
    plants: Plants = None
    paths: Paths = None
    crs: Crs = None
    layer: Layer = None
    plot_option: PlotChoices = None
    record_option: RecordChoices = None
    plants_option: PlantsChoices = None
    paths_option: PathsChoices = None
    rows: Rows = None
    rows_option: RowsChoices = None
    contours: Contours = None
    contours_option: ContoursChoices = None
    blocks: Blocks = None
    blocks_option: BlocksChoices = None
    guess_blocks: GuessBlocks = False

    def _refuse_of_plot(self, role: str) -> None:
        """Refuse what is said of a plot file where another file, of `role`, is the first."""
        named = {"crs": self.crs, "layer": self.layer}
        said = {f"--{name} {value}": f"{name}={value}" for name, value in named.items() if value}
        said |= {f"--plot-option {value}": value for value in self.plot_option or ()}
        if said:
            instead = " ".join(f"--{role}-option {shlex.quote(one)}" for one in said.values())
            raise SettingError(
                f"A plot file must be given for {', '.join(said)}, but none is. Of the file of "
                f"--{role} say it with {instead}."
            )

    def sources(self, plot: Path | None, feature: str | None) -> PlotSources:
        """Return the plot's files, given the first of them."""
        from fieldmon.io.options import PlotOptions, ReadOptions
        from fieldmon.io.plot_request import PlotSources

        if plot is None and self.plants is None and self.rows is None:
            raise SettingError(
                "Give a plot file, or the positions of its plants with --plants FILE, or its rows "
                "with --rows FILE."
            )
        if plot is None:
            self._refuse_of_plot("rows" if self.plants is None else "plants")
        return PlotSources(
            plot,
            plot_options(feature, self.crs, self.layer, self.plot_option),
            self.plants,
            _of(ReadOptions(), self.plants_option, self.plants, "plants"),
            self.paths,
            _of(ReadOptions(), self.paths_option, self.paths, "paths"),
            None if self.gate is None else _lonlat(self.gate),
            self.rows,
            _of(ReadOptions(), self.rows_option, self.rows, "rows"),
            self.contours,
            _raster_options(self.contours_option, self.contours),
            self.blocks,
            _of(PlotOptions(), self.blocks_option, self.blocks, "blocks"),
            self.guess_blocks,
        )


@dataclass(frozen=True)
class PlotFiles:
    """All that a plot is prepared from, beside its own file and that of the records."""

    rows: RowOptions = field(default_factory=RowOptions)
    files: FileOptions = field(default_factory=FileOptions)
    rasters: RasterFiles = field(default_factory=RasterFiles)

    def request(self, plot: Path | None, feature: str | None, records: Path | None) -> PlotRequest:
        """Return what to prepare from the command's files."""
        from fieldmon.io.options import RecordOptions
        from fieldmon.io.plot_request import PlotRequest, RecordSource

        flags = "--record-option", "--records"
        options = chosen_of_file(RecordOptions(), self.files.record_option, records, flags)
        return PlotRequest(
            self.files.sources(plot, feature),
            self.rows.choices(),
            None if records is None else RecordSource(records, options),
            self.rasters.canopy_source(),
            self.rasters.risk_source(),
        )


def plot_options(
    feature: str | None, crs: str | None, layer: str | None, more: list[str] | None
) -> PlotOptions:
    """Return how a plot file is read."""
    from fieldmon.io.options import PlotOptions

    return chosen(PlotOptions(feature=feature, crs=crs, layer=layer), more)


def refuse_idle_every(names: Sequence[str], every: int | None) -> None:
    """Refuse --every where none of the samplers inspects every N-th; one of one's own does not."""
    having_n = (kind_of(name).every is not None for name in names if not is_own(name))
    if every is None or any(having_n):
        return
    having = ", ".join(name for name, kind in SAMPLERS.items() if kind.every is not None)
    raise SettingError(
        f"--every goes with a sampler that inspects every N-th ({having}), but this is "
        f"{' and '.join(names)}. Leave it out, or choose another one with --sampler."
    )


def sampler_settings(name: str, every: int | None) -> dict[str, float]:
    """Return what was said of a sampler; refuse what it does not hear of."""
    refuse_idle_every([name], every)
    return kind_of(name).settings_for(every)


def sampler_of(name: str, every: int | None) -> Sampler:
    """Return the sampler that was chosen; refuse an N of which it does not hear."""
    refuse_idle_every([name], every)
    return sampler_with(name, every)


def _of(options: Options, more: list[str] | None, file: Path | None, role: str) -> Options:
    """Return how the file of a role is read."""
    return chosen_of_file(options, more, file, (f"--{role}-option", f"--{role}"))


def _raster_options(given: list[str] | None, file: Path | None) -> RasterOptions | None:
    """Return how heights are read; None: as they say, and nothing heavy is loaded for it."""
    if not given:
        return None
    from fieldmon.io.rasters.values import RasterOptions

    return _of(RasterOptions(), given, file, "contours")


def _lonlat(text: str) -> tuple[float, float]:
    try:
        lon, lat = (float(part) for part in text.split(","))
    except ValueError as error:
        raise SettingError(
            f"--gate must be LON,LAT in degrees, such as 35.15,30.36, but it is {text!r}."
        ) from error
    return lon, lat
