"""From a session's files to a plot with its plants, its records and its risk, step by step.

The way is that of `fieldmon.io.prepare`; each step is kept, and what a person draws comes between.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import streamlit as st

from fieldmon.errors import FieldmonError
from fieldmon.infestation.records import Records
from fieldmon.io.drawn_rows import parted
from fieldmon.io.open_sea import said_of_place
from fieldmon.io.options import PlotOptions, ReadOptions, RecordOptions
from fieldmon.io.plot_request import PlantingChoices, PlotSources, RecordSource
from fieldmon.io.prepare import with_plants
from fieldmon.io.prepared_plots import Laid
from fieldmon.io.unused_row_settings import unused_of

from . import brought_files, cached, cached_files, rasters, sample_estate
from .brought_files import File, FileMessage, LeftOut, answers, messages_of, settled
from .plot_edits import Edit, edited
from .row_settings import block_settings, row_settings

if TYPE_CHECKING:
    from collections.abc import Callable

    from fieldmon.io.readers.places import Plants
    from fieldmon.plot.field import Field
    from fieldmon.plot.plot import Plot

    #: asks which plot of a file is meant, by the file and the plots' names
    Which = Callable[[File, tuple[Field, ...]], int]

#: what is put into cache keys for the sample estate's files
_SAMPLE = "sample/"
_LAYING = "laying"
_NOWHERE = "A plot must have a boundary or measured plants, but its files hold neither."


@dataclass(frozen=True, eq=False)
class Files:
    """The files that make a plot: a boundary or measured plants or both, records, rows, blocks."""

    plot: File | None
    records: File | None
    plants: File | None
    rows: File | None = None
    blocks: File | None = None

    @property
    def place(self) -> File:
        """Return the file that says where the plot lies."""
        if (file := self.plot or self.plants) is None:
            raise RuntimeError(_NOWHERE)
        return file


@dataclass(frozen=True, eq=False)
class Outline:
    """A plot as its files draw it, before plants are laid.

    Parameters
    ----------
    key
        Names it in cache keys.
    field
        Its boundary and what was drawn with it; None if there are measured plants only.
    fields
        Every plot of its file, which records may name.
    measured
        Plants measured on it; None if there are none.
    messages
        What the import had to say.
    """

    key: str
    field: Field | None
    fields: tuple[Field, ...]
    measured: Plants | None
    messages: tuple[FileMessage, ...]


@dataclass(frozen=True, eq=False)
class PlotFromFiles:
    """A plot that is ready to be planned.

    Parameters
    ----------
    key
        Stands for all of it in cache keys.
    plot, records
        The plot with its plants, and the records near it.
    risk
        ``(n,)`` risk of the plants from a raster, or None.
    messages
        What the imports had to say.
    left_out
        The records, where they could not be used: one file must not lock a plot out.
    """

    key: str
    plot: Plot
    records: Records
    risk: cached.Array | None
    messages: tuple[FileMessage, ...]
    left_out: tuple[LeftOut, ...] = ()


def of_sample() -> Files:
    """Return the files of the sample estate."""
    plots = _sample(brought_files.PLOT, sample_estate.PLOTS)
    return Files(plots, _sample(brought_files.RECORDS, sample_estate.RECORDS), None)


def of_session() -> Files | None:
    """Return the files that this session brought; None while they make no plot."""
    kept = brought_files.brought()
    kinds = (brought_files.PLOT, brought_files.RECORDS, brought_files.PLANTS,
             brought_files.ROWS, brought_files.BLOCKS)  # fmt: skip
    files = Files(*(kept.get(kind) for kind in kinds))
    return None if files.plot is None and files.plants is None else files


def brought() -> Files:
    """Return the same where they make a plot for sure."""
    if (files := of_session()) is None:
        raise RuntimeError(_NOWHERE)
    return files


def _sample(kind: str, name: str) -> File:
    return File(_SAMPLE + name, sample_estate.FOLDER / name, kind)


def outline(files: Files, which: Which) -> Outline:
    """Return the plot that `which` answers with, and its measured plants."""
    measured, heard, key = _measured(files.plants)
    if files.plot is None:
        return Outline(key, None, (), measured, heard)
    options = settled(files.plot, PlotOptions())
    # who drew the plot knows of no column
    named = replace(options, name_column="name") if files.plot.is_drawn else options
    read = cached_files.plots(files.plot.key, named, files.plot.source)
    number = which(files.plot, read.value)
    field = read.value[number]
    key = f"{key}{files.plot.key}{options}{number}"
    if measured is not None and files.plants is not None:
        far = settled(files.plants, ReadOptions()).far
        here = cached_files.plants_on(key, far, measured, field)
        measured, heard = here.value, (*heard, *messages_of(files.plants, here))
        field = with_plants(field, measured)
    field, drawn_there, longer = _with_drawn(files, field)
    if files.plot.key.startswith(_SAMPLE):
        paths = cached_files.paths(sample_estate.FOLDER / sample_estate.PATHS)
        field = replace(field, paths=paths)
    said = messages_of(files.plot, read)
    own = (
        FileMessage(one.asked, message) for one in said for message in one.message.about(field.name)
    )
    said = (*own, *heard, *drawn_there)
    return Outline(f"{key}{longer}", field, read.value, measured, said)


def _measured(file: File | None) -> tuple[Plants | None, tuple[FileMessage, ...], str]:
    if file is None:
        return None, (), ""
    options = settled(file, ReadOptions())
    read = cached_files.measured_plants(file.key, options, file.source)
    return read.value, messages_of(file, read), f"{file.key}{options}"


def _with_drawn(files: Files, field: Field) -> tuple[Field, tuple[FileMessage, ...], str]:
    """Return a field with the rows and blocks that were brought, what was said, and their key."""
    said: tuple[FileMessage, ...] = ()
    key = ""
    if (file := files.rows) is not None and field.plants is None:
        options = settled(file, ReadOptions())
        rows = cached_files.drawn_rows(file.key, options, file.source)
        field = replace(field, row_lines=rows.value)
        said, key = messages_of(file, rows), f"{file.key}{options}"
    if (file := files.blocks) is not None:
        options = settled(file, PlotOptions())
        blocks = parted((field,), cached_files.drawn_blocks(file.key, options, file.source))
        (field,) = blocks.value
        said, key = (*said, *messages_of(file, blocks)), f"{key}{file.key}{options}"
    return field, said, key


def prepared(files: Files, outline: Outline) -> PlotFromFiles:
    """Return the plot with its plants, records and risk."""
    plot, key = _plot(files, outline)
    # records may name plants by numbers that count those missing too
    records, read, left_out, key = _records(files.records, outline, plot, key)
    plot, missing, key = rasters.without_missing(plot, key)
    risk, said, key = rasters.risk(plot, key)
    of_rows = _said_of_rows(files, plot, outline.key)
    messages = (*outline.messages, *_said_of_place(files, plot), *of_rows, *missing, *read, *said)
    return PlotFromFiles(key, plot, records, risk, messages, left_out)


def _said_of_place(files: Files, plot: Plot) -> tuple[FileMessage, ...]:
    """Return what is doubtful about where the plot lies, of the file that says where."""
    asked = files.place.asked
    exchanged = dict(answers(asked)).get("swap_axes") == "yes"
    said = said_of_place(plot.field, exchanged=exchanged)
    return tuple(FileMessage(asked, message) for message in said)


def _said_of_rows(files: Files, plot: Plot, plot_key: str) -> tuple[FileMessage, ...]:
    """Return how plants stand in rows, as it is said of the file that tells of them."""
    file = files.plants or files.rows or files.place
    unused = unused_of(plot.field, PlantingChoices(**row_settings(plot_key)))
    return tuple(FileMessage(file.asked, message) for message in (*Laid(plot).messages, *unused))


def _plot(files: Files, outline: Outline) -> tuple[Plot, str]:
    """Return the plot with its plants, as the row settings and what was drawn say."""
    st.session_state[_LAYING] = outline.key
    edits, field = drawn(outline.key), outline.field
    if field is None:
        around, key = _around(files, outline)
        if not edits:
            return around, key
        field = around.field
    return laid(outline.key, edits, field, edits)


def _around(files: Files, outline: Outline) -> tuple[Plot, str]:
    """Return the plot of measured plants about which nobody drew a boundary."""
    if files.plants is None or outline.measured is None:
        raise RuntimeError(_NOWHERE)
    choices = PlantingChoices(**row_settings(outline.key))
    sources = PlotSources(plants=files.plants.source)
    around = cached_files.plot_around(outline.key, choices, sources, outline.measured)
    return around, f"{outline.key}{choices}"


def laying() -> str:
    """Return the key of the plot whose plants were laid last, or could not be."""
    key: str = st.session_state.get(_LAYING, "")
    return key


def laid(
    plot_key: str, edits: tuple[Edit, ...], field: Field, new: tuple[Edit, ...]
) -> tuple[Plot, str]:
    """Return the plot on which all `edits` are drawn, the `new` ones of them not yet on `field`."""
    choices = PlantingChoices(**row_settings(plot_key))
    field = edited(field, new)
    by_hand = [block_settings(plot_key, block.name) for block in field.blocks]
    planted = tuple(
        replace(block, **said) for block, said in zip(field.blocks, by_hand, strict=True)
    )
    key = f"{plot_key}{edits}{by_hand if any(by_hand) else ''}"
    return cached_files.plot(key, choices, replace(field, blocks=planted)), f"{key}{choices}"


def drawn(plot_key: str) -> tuple[Edit, ...]:
    """Return what was drawn on a plot, in order."""
    edits: tuple[Edit, ...] = st.session_state.get(f"edits {plot_key}", ())
    return edits


def draw(plot_key: str, edits: tuple[Edit, ...]) -> None:
    """Keep what was drawn on a plot."""
    st.session_state[f"edits {plot_key}"] = edits


def _records(
    file: File | None, outline: Outline, plot: Plot, key: str
) -> tuple[Records, tuple[FileMessage, ...], tuple[LeftOut, ...], str]:
    """Return the records, what was said, whether they had to be left out, and the longer key."""
    if file is None:
        return Records.none(), (), (), key
    try:
        options = settled(file, RecordOptions())
        longer = f"{key}{file.key}{options}"
        source = RecordSource(file.source, options)
        read = cached_files.records(longer, source, plot, outline.fields, outline.measured)
    except FieldmonError as problem:
        return Records.none(), (), (LeftOut(file, problem),), key
    return read.value, messages_of(file, read), (), longer
