"""From a source and what was chosen to one layer, whatever the file is."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fieldmon.errors import ChoiceNeeded, FileProblem
from fieldmon.io.formats.gdal import list_layers as gdal_layers
from fieldmon.io.formats.gdal import read_layer, read_shapefile
from fieldmon.io.formats.geojson import read_geojson
from fieldmon.io.formats.geoparquet import read_parquet
from fieldmon.io.formats.layer import Layer, LayerInfo
from fieldmon.io.formats.signatures import TABULAR, VECTOR, Kind
from fieldmon.io.formats.tables import read_sheet, read_text_table, sheet_names
from fieldmon.io.import_report import seen
from fieldmon.io.options import ReadOptions, Source, source_name
from fieldmon.io.sandbox.unpack import Member, Workroom, choose_member, members

if TYPE_CHECKING:
    from pathlib import Path

_NOTES = (".txt", ".md", ".html", ".xml", ".json.txt")


class Choice(NamedTuple):
    """A data set on its own in the work folder, and what it is called."""

    member: Member
    path: Path
    name: str


def layers_of(source: Source, workroom: Workroom) -> tuple[LayerInfo, ...]:
    """Return every layer of every file that a source holds."""
    infos = []
    for member in _data_sets(members(source, workroom)):
        choice = Choice(member, workroom.stage(member), member.name)
        infos += [LayerInfo(member.name, one.layer, one.geometry_type) for one in _listed(choice)]
    return tuple(infos)


def open_layer(source: Source, options: ReadOptions, workroom: Workroom) -> Layer:
    """Return the one layer meant; raise `ChoiceNeeded` where several could be."""
    found = _data_sets(members(source, workroom))
    member = choose_member(found, options.member, source_name(source))
    choice = Choice(member, workroom.stage(member), member.name)
    return _read(choice, options).where(options.where).checked()


def _data_sets(found: tuple[Member, ...]) -> tuple[Member, ...]:
    """Return the members that hold vectors or tables; notes count only where nothing else is."""
    usable = tuple(m for m in found if m.kind in VECTOR | TABULAR)
    vectors = tuple(m for m in usable if m.kind in VECTOR)
    tables = tuple(m for m in usable if not m.name.lower().endswith(_NOTES))
    if not usable:
        raise FileProblem(
            f"{found[0].name} is a raster, which holds no plots or records. "
            "Choose it as a backdrop or covariate instead."
        )
    return vectors or tables or usable


def _listed(choice: Choice) -> list[LayerInfo]:
    kind = choice.member.kind
    if kind is Kind.WORKBOOK:
        names = sheet_names(choice.path, choice.name)
        return [LayerInfo(choice.name, sheet, None) for sheet in names]
    if kind in {Kind.GEOJSON, Kind.PARQUET}:
        return [LayerInfo(choice.name, choice.member.stem, "Unknown")]
    if kind is Kind.TABLE:
        return [LayerInfo(choice.name, choice.member.stem, None)]
    listed = gdal_layers(choice.path, choice.name)
    if kind is Kind.SHAPEFILE:
        return [LayerInfo(choice.name, choice.member.stem, listed[0].geometry_type)]
    return [LayerInfo(choice.name, one.name, one.geometry_type) for one in listed]


def _read(choice: Choice, options: ReadOptions) -> Layer:
    kind = choice.member.kind
    if kind is Kind.GEOJSON:
        return read_geojson(choice.path, choice.member.stem, options.encoding)
    if kind is Kind.PARQUET:
        return read_parquet(choice.path, choice.member.stem)
    if kind is Kind.TABLE:
        return read_text_table(choice.path, choice.member.stem, options)
    if kind is Kind.SHAPEFILE:
        return read_shapefile(choice.path, choice.member.stem, options.encoding)
    if kind is Kind.WORKBOOK:
        return _only_layer(choice, options, sheet_names(choice.path, choice.name))
    listed = gdal_layers(choice.path, choice.name)
    names = tuple(one.name for one in listed)
    spatial = tuple(one.name for one in listed if one.geometry_type is not None)
    # a plain table beside maps is read only when it is asked for by name
    return _only_layer(choice, options, names if options.layer in names else spatial or names)


def _only_layer(choice: Choice, options: ReadOptions, names: tuple[str, ...]) -> Layer:
    """Return the layer named, or the only one that holds anything."""
    if options.layer is not None:
        if options.layer in names:
            return _layer(choice, options.layer)
        raise _which_layer(choice, names, f", but none is called {options.layer!r}")
    full = _full_layers(choice, names)
    if len(full) > 1:
        raise _which_layer(choice, tuple(full), " with something in them")
    if not full:
        raise FileProblem(
            f"{choice.name} must hold at least one layer with something in it, but holds none."
        )
    ((called, layer),) = full.items()
    if len(names) == 1:
        return layer
    return layer.saying(seen(f"Layer {called} was read; {len(names) - 1} other(s) hold nothing."))


def _full_layers(choice: Choice, names: tuple[str, ...]) -> dict[str, Layer]:
    full = {}
    for name in names:
        try:
            layer = _layer(choice, name)
        except FileProblem:
            if len(names) == 1:
                raise
            continue
        if len(layer):
            full[name] = layer
    return full


def _layer(choice: Choice, layer: str) -> Layer:
    if choice.member.kind is Kind.WORKBOOK:
        return read_sheet(choice.path, choice.name, layer)
    return read_layer(choice.path, choice.name, layer)


def _which_layer(choice: Choice, names: tuple[str, ...], more: str) -> ChoiceNeeded:
    return ChoiceNeeded(
        f"{choice.name} holds {len(names)} layers{more}. Choose one of: {', '.join(names[:20])}.",
        "layer",
        names,
    )
