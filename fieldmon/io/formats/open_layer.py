"""From a source and what was chosen to one layer, whatever the file is.

GDAL and Parquet take half a second to load: they wait for a file that needs them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.geojson import read_geojson
from fieldmon.io.formats.isoxml import read_isoxml
from fieldmon.io.formats.layer import Layer, LayerInfo
from fieldmon.io.formats.signatures import TABULAR, VECTOR, WORKBOOKS, FileKind
from fieldmon.io.formats.tables import read_sheet, read_text_table
from fieldmon.io.formats.workbooks import sheet_names
from fieldmon.io.import_report import seen
from fieldmon.io.options import PlotOptions, ReadOptions, Source, source_name
from fieldmon.io.sandbox.unpack import choose_member, is_of_several, members, of_all, unread

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fieldmon.io.formats.gdal import GdalLayer
    from fieldmon.io.sandbox.file_entries import Member
    from fieldmon.io.sandbox.workroom import Workroom

_MAPINFO = frozenset({FileKind.MAPINFO_TAB, FileKind.MAPINFO_MIF})
#: layers of a GPX file that hold the positions of another one
_FIXES_OF = {"track_points": "tracks", "route_points": "routes"}
_NOTES = (".txt", ".md", ".html", ".xml", ".json.txt")


class StagedMember(NamedTuple):
    """A data set on its own in the work folder, and what it is called."""

    member: Member
    path: Path
    name: str


def layers_of(source: Source, workroom: Workroom) -> tuple[LayerInfo, ...]:
    """Return every layer of every file that a source holds."""
    infos = []
    for member in _data_sets(members(source, workroom)):
        staged = StagedMember(member, workroom.stage(member), member.name)
        infos += [LayerInfo(member.name, one.layer, one.geometry_type) for one in _listed(staged)]
    return tuple(infos)


def open_layer(source: Source, options: ReadOptions, workroom: Workroom) -> Layer:
    """Return the one layer meant; raise `ChoiceNeeded` where several could be."""
    found = _data_sets(members(source, workroom))
    try:
        member = choose_member(found, options.member, source_name(source))
    except ChoiceNeeded:
        if is_of_several(source):
            _must_hold_one(found, source, options, workroom)
        raise
    staged = StagedMember(member, workroom.stage(member), member.name)
    try:
        layer = _read(staged, options).with_roles(options.columns)
    except FileProblem as problem:
        raise of_all([problem, *unread(source, workroom)]) from problem
    pests = [name for role, name in options.columns if role == "species"]
    return layer.where(options.where, pests).checked()


def _must_hold_one(
    found: tuple[Member, ...], source: Source, options: ReadOptions, workroom: Workroom
) -> None:
    """Raise a problem that names all files brought at once, if none of them can be read."""
    problems = []
    for member in found:
        try:
            _read(StagedMember(member, workroom.stage(member), member.name), options)
        except FileProblem as problem:
            problems.append(problem)
        except ChoiceNeeded:
            return
        else:
            return
    raise of_all([*problems, *unread(source, workroom)])


def _data_sets(found: tuple[Member, ...]) -> tuple[Member, ...]:
    """Return the members that hold vectors or tables; notes count only where nothing else is."""
    usable = tuple(m for m in found if m.kind in VECTOR | TABULAR)
    vectors = tuple(m for m in usable if m.kind in VECTOR)
    tables = tuple(m for m in usable if not m.name.lower().endswith(_NOTES))
    if not usable:
        raise FileProblem(
            worded(
                "{name} is a raster, which holds no areas, lines, points or table. Give a file "
                "that does, as .gpkg, .shp.zip, .kml or .geojson; or choose it as a backdrop or "
                "covariate.",
                name=found[0].name,
            )
        )
    return vectors or tables or usable


def _listed(staged: StagedMember) -> list[LayerInfo]:
    kind = staged.member.kind
    if kind in WORKBOOKS:
        names = sheet_names(staged.path, staged.name)
        return [LayerInfo(staged.name, sheet, None) for sheet in names]
    if kind in {FileKind.SHAPEFILE, *_MAPINFO}:
        shapes = _gdal_layers(staged)[0].geometry_type
        return [LayerInfo(staged.name, staged.member.stem, shapes)]
    if kind in _READERS:
        shapes = None if kind is FileKind.TABLE else "Unknown"
        return [LayerInfo(staged.name, staged.member.stem, shapes)]
    listed = _gdal_layers(staged)
    return [LayerInfo(staged.name, one.name, one.geometry_type) for one in listed]


def _read(staged: StagedMember, options: ReadOptions) -> Layer:
    kind = staged.member.kind
    if kind in _READERS:
        read = _READERS[kind](staged.path, staged.name, options)
        return replace(read, stem=staged.member.stem)
    if kind in WORKBOOKS:
        return _only_layer(staged, options, sheet_names(staged.path, staged.name))
    listed = _gdal_layers(staged)
    names = tuple(one.name for one in listed)
    spatial = tuple(one.name for one in listed if one.geometry_type is not None)
    # a plain table beside maps is read only when it is asked for by name
    asked = names if options.layer in names else spatial or names
    return _only_layer(staged, options, asked, _OF_SEASON if {*names} >= _SEASONS else "")


def _parquet(path: Path, name: str, _: ReadOptions) -> Layer:
    from fieldmon.io.formats.geoparquet import read_parquet  # noqa: PLC0415

    return read_parquet(path, name)


def _shapefile(path: Path, name: str, options: ReadOptions) -> Layer:
    from fieldmon.io.formats.gdal import read_shapefile  # noqa: PLC0415

    return read_shapefile(path, name, options.encoding)


def _mapinfo(path: Path, name: str, _: ReadOptions) -> Layer:
    from fieldmon.io.formats.gdal import read_mapinfo  # noqa: PLC0415

    return read_mapinfo(path, name)


# layers of a season's file, and what is said of one that is read as a plot or as records
_SEASONS = {"fieldmon", "batches", "inspections"}
_OF_SEASON = ", as the file of a season (fieldmon status opens it as one)"

_READERS: dict[FileKind, Callable[[Path, str, ReadOptions], Layer]] = {
    FileKind.GEOJSON: lambda path, name, options: read_geojson(path, name, options.encoding),
    FileKind.PARQUET: _parquet,
    FileKind.TABLE: read_text_table,
    FileKind.SHAPEFILE: _shapefile,
    FileKind.ISOXML: lambda path, name, _: read_isoxml(path, name),
    FileKind.MAPINFO_TAB: _mapinfo,
    FileKind.MAPINFO_MIF: _mapinfo,
}


def _gdal_layers(staged: StagedMember) -> list[GdalLayer]:
    from fieldmon.io.formats.gdal import list_layers  # noqa: PLC0415

    return list_layers(staged.path, staged.name)


def _only_layer(
    staged: StagedMember, options: ReadOptions, names: tuple[str, ...], more: str = ""
) -> Layer:
    """Return the layer named, or the only one that holds anything; `more` is of the question."""
    if options.layer is not None:
        if options.layer in names:
            return _layer(staged, options.layer, options)
        raise _which_layer(staged, names, f", but none is called {options.layer!r}")
    full = _full_layers(staged, options, names)
    if isinstance(options, PlotOptions):
        # fixes of a track or route say of a plot what it says itself
        names = tuple(name for name in names if _FIXES_OF.get(name) not in full)
        full = {name: layer for name, layer in full.items() if name in names}
    if len(full) > 1:
        raise _which_layer(staged, tuple(full), f" with something in them{more}")
    if not full:
        raise FileProblem(
            worded(
                "{name} must hold at least one layer with something in it, but holds none.",
                name=staged.name,
            )
        )
    ((called, layer),) = full.items()
    if isinstance(layer, ChoiceNeeded):
        raise layer
    if len(names) == 1:
        return layer
    return layer.saying(
        seen(
            worded(
                "Layer {called} was read; {value} {value:other holds|others hold} nothing.",
                called=called,
                value=len(names) - 1,
            )
        )
    )


def _full_layers(
    staged: StagedMember, options: ReadOptions, names: tuple[str, ...]
) -> dict[str, Layer | ChoiceNeeded]:
    """Return the layers that hold anything, or what one of them asks."""
    full: dict[str, Layer | ChoiceNeeded] = {}
    for name in names:
        try:
            layer = _layer(staged, name, options)
        except FileProblem:
            if len(names) == 1:
                raise
            continue
        except ChoiceNeeded as question:
            full[name] = question
            continue
        if len(layer):
            full[name] = layer
    return full


def _layer(staged: StagedMember, layer: str, options: ReadOptions) -> Layer:
    if staged.member.kind in WORKBOOKS:
        return read_sheet(staged.path, staged.name, layer, options)
    from fieldmon.io.formats.gdal import read_layer  # noqa: PLC0415

    read = read_layer(staged.path, staged.name, layer)
    if read.name != staged.path.stem:
        return read
    # a file whose only layer has no name is given that of the copy
    return replace(read, name=staged.name, stem=staged.member.stem)


def _which_layer(staged: StagedMember, names: tuple[str, ...], more: str) -> ChoiceNeeded:
    return ChoiceNeeded(
        worded(
            "{name} holds {n} layers{more}. Choose one of: {names}.",
            name=staged.name,
            n=len(names),
            more=more,
            names=", ".join(names[:20]),
        ),
        "layer",
        names,
    )
