"""What a file is read from, and what people may choose about how it is read."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Self, TypeAlias

from fieldmon.compute.wording import worded
from fieldmon.errors import SettingError
from fieldmon.plot.local_clock import local_clock
from fieldmon.plot.plants_outside import FAR

if TYPE_CHECKING:
    from fieldmon.plot.field import Field

DateOrder: TypeAlias = Literal["dmy", "mdy", "ymd"]

#: what a column can hold, with the words that explain it
ROLES = {
    "lon": "longitude, degrees",
    "lat": "latitude, degrees",
    "position": "latitude and longitude in one column",
    "x": "easting, in the unit of the coordinate system",
    "y": "northing, in the unit of the coordinate system",
    "crs": "coordinate system of each record (Darwin Core geodeticDatum)",
    "accuracy": "accuracy of the position, metres",
    "date": "date",
    "year": "year",
    "month": "month",
    "day": "day of the month",
    "count": "pests counted",
    "present": "presence or absence",
    "species": "species",
    "stage": "stage of life",
    "leaves": "leaves looked at",
    "plot": "name of the plot",
    "block": "name of the block",
    "row": "number of the row",
    "plant": "number of the plant",
    "name": "name of the feature",
}
#: what else questions call a role
_ALSO = {"found": "present", "result": "present"}


@dataclass(frozen=True)
class Upload:
    """A file that came as bytes, with the name it had.

    Parameters
    ----------
    name
        File name as the person knows it; only its ending is ever used.
    data
        The bytes.
    """

    name: str
    data: bytes


#: a path (file or folder), an uploaded file, or several uploaded files that belong together
Source: TypeAlias = str | Path | Upload | tuple[Upload, ...]


def source_name(source: Source) -> str:
    """Return what to call a source in a sentence."""
    if isinstance(source, Upload):
        return source.name
    if isinstance(source, tuple):
        return ", ".join(part.name for part in source[:3]) + (", ..." if len(source) > 3 else "")
    return Path(source).name or str(source)


_FARTHEST_DOUBLES_M = 10.0


@dataclass(frozen=True)
class ReadOptions:
    """What can be chosen for any file.

    Parameters
    ----------
    member
        Which file of an archive or folder, as `list_layers` names it.
    layer
        Which layer of a file, or sheet of a workbook.
    where
        ``"column=value"``: take only these features or records.
    crs
        Coordinate system of the file where it states none or a wrong one: ``"EPSG:2039"``.
    swap_axes
        Read the first coordinate as the second: for latitude and longitude in the wrong order.
    encoding
        How the text is written: ``"cp1255"``, ``"utf-8"``...
    country
        English name of the country; ranks the coordinate systems that are offered.
    near
        ``(lon, lat)`` of a place close by; ranks them too, and shows swapped coordinates.
    columns
        Pairs of a role (see `ROLES`) and the column that holds it; ``("plot", "")``: none does.
    decimal
        ``"."`` or ``","`` in a text table.
    delimiter
        What separates the cells of a text table.
    header
        Whether the first line of a table names its columns: ``"yes"`` or ``"no"``.
    degrees
        What 35.26.33 means: ``"dms"``, degrees, minutes and seconds; ``"dm"``, degrees and minutes
        with decimals. None: nothing.
    doubles
        ``"one"``: of plants closer than 5 cm to each other, one is kept. ``"0.5"``: of those closer
        than so many metres.
    far
        ``"keep"``: a few plants over a kilometre from all others, and those outside their plot,
        stay. ``"drop"``: plants just outside their plot go, too.
    """

    member: str | None = None
    layer: str | None = None
    where: str | None = None
    crs: str | None = None
    swap_axes: bool = False
    encoding: str | None = None
    country: str | None = None
    near: tuple[float, float] | None = None
    columns: tuple[tuple[str, str], ...] = ()
    decimal: str | None = None
    delimiter: str | None = None
    header: str | None = None
    degrees: str | None = None
    doubles: str | None = None
    far: str | None = None

    def __post_init__(self) -> None:
        known = {_ALSO.get(role, role): column for role, column in self.columns}
        object.__setattr__(self, "columns", tuple(known.items()))
        for role, _ in self.columns:
            if role not in ROLES:
                raise SettingError(
                    worded(
                        "A column can be named for one of {names}, but not for {role!r}.",
                        names=", ".join(ROLES),
                        role=role,
                    )
                )
        if self.where is not None and "=" not in self.where:
            raise SettingError(
                worded(
                    "The choice of features must read column=value, but it is {where!r}.",
                    where=self.where,
                )
            )
        self._check_words()
        if self.delimiter is not None and len(self.delimiter) != 1:
            raise SettingError(
                worded(
                    "A delimiter must be one character, but it is {delimiter!r}.",
                    delimiter=self.delimiter,
                )
            )
        if self.near is not None:
            lon, lat = self.near
            if not (-180.0 <= lon <= 180.0 and -90.0 <= lat <= 90.0):
                raise SettingError(
                    worded(
                        "A place nearby must be a longitude in -180..180 and "
                        "a latitude in -90..90, but it is ({lon}, {lat}).",
                        lon=lon,
                        lat=lat,
                    )
                )

    def _check_words(self) -> None:
        """Refuse words that options do not have."""
        for what, told, words in (
            ("The decimal mark", self.decimal, (".", ",")),
            ("Whether a line names the columns", self.header, ("yes", "no")),
            ("What 35.26.33 means", self.degrees, ("dms", "dm")),
            ("What is done with doubles", self._doubles_word, ("one",)),
            ("What is done with plants far away", self.far, FAR),
        ):
            if told is not None and told not in words:
                may_be = " or ".join(words)
                comma = "" if may_be.endswith(",") else ","
                raise SettingError(
                    worded(
                        "{what} must be {may_be}{comma} but it is {told!r}.",
                        what=what,
                        may_be=may_be,
                        comma=comma,
                        told=told,
                    )
                )

    @property
    def _doubles_word(self) -> str | None:
        """Return what is said of doubles unless it is a distance."""
        return None if self.doubles_m else self.doubles

    @property
    def doubles_m(self) -> float | None:
        """Return how near to each other plants are one, if a distance is said, else None."""
        with suppress(ValueError):
            metres = float(self.doubles or "")
            return metres if 0.0 < metres <= _FARTHEST_DOUBLES_M else None
        return None

    def column(self, role: str) -> str | None:
        """Return the column named by hand for a role, or None."""
        return dict(self.columns).get(role)

    @property
    def named_columns(self) -> frozenset[str]:
        """The columns named by hand for any role; one that is empty stands for none."""
        return frozenset(dict(self.columns).values())

    def naming(self, **columns: str) -> Self:
        """Return these options with columns named by hand: ``naming(date="Datum")``."""
        return replace(self, columns=(*self.columns, *columns.items()))

    def choose(self, option: str, value: str) -> Self:
        """Return these options with one of them set from text, as a `Remedy` or choice holds it."""
        if option == "columns":
            role, _, column = value.partition("=")
            return self.naming(**{role: column})
        if option not in {field.name for field in fields(self)}:
            raise SettingError(
                worded("There is no option {option!r} for this file.", option=option)
            )
        if isinstance(getattr(self, option), bool):
            return replace(self, **{option: yes_or_no(option, value)})  # type: ignore[arg-type]
        if option == "header":
            return replace(self, header="yes" if yes_or_no(option, value) else "no")
        if option == "near":
            return replace(self, near=_lonlat(value))
        return replace(self, **{option: value})  # type: ignore[arg-type]


@dataclass(frozen=True)
class PlotOptions(ReadOptions):
    """What can be chosen when plots are read.

    Parameters
    ----------
    feature
        Only this plot: its name, or its number counted from 1. None: all of them.
    name_column
        Column that names the plots.
    outline
        Points, or a line that does not close, are the corners of one plot in their order.
    """

    feature: str | int | None = None
    name_column: str | None = None
    outline: bool = False


@dataclass(frozen=True)
class RecordOptions(ReadOptions):
    """What can be chosen when pest records are read.

    Parameters
    ----------
    date_order
        ``"dmy"``, ``"mdy"`` or ``"ymd"``: what 03/04/2026 means.
    plot
        The plot whose rows and plants the records name, where no column says which.
    found, clean
        Words of one's own for a plant with pests and for one without, set apart by commas.
    place
        Where a record lies that gives a position and names a plant, too: ``"position"`` or
        ``"plant"``. None: at the position, and it is doubted where the two disagree.
    """

    date_order: DateOrder | None = None
    plot: str | None = None
    found: str | None = None
    clean: str | None = None
    place: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.place not in {None, "position", "plant"}:
            raise SettingError(
                worded(
                    "The place of records must be that of their position or of their plant, but "
                    "it is {place!r}. Say position or plant.",
                    place=self.place,
                )
            )
        if self.date_order not in {None, "dmy", "mdy", "ymd"}:
            raise SettingError(
                worded(
                    "The order of a date must be dmy, mdy or ymd, but it is {date_order!r}.",
                    date_order=self.date_order,
                )
            )


@dataclass(frozen=True)
class ZonedOptions(RecordOptions):
    """What can be chosen of records whose times are of a zone.

    Parameters
    ----------
    zone
        The time zone (``"Asia/Jerusalem"``, ``"+02:00"``): each kind says of which times.
    """

    zone: str | None = None

    def on(self, field: Field) -> Self:
        """Return these options with the time zone in which a plot lies, where none was told."""
        return self if self.zone else replace(self, zone=local_clock(field).zone or None)


_YES, _NO = {"yes", "true", "1", "on"}, {"no", "false", "0", "off"}


def yes_or_no(option: str, said: object) -> bool:
    """Return whether an option is said to hold: True, or yes, true, 1 or on in any case."""
    word = str(said).strip().casefold()
    if word not in _YES | _NO:
        raise SettingError(
            worded("{option} must be yes or no, but it is {said!r}.", option=option, said=said)
        )
    return word in _YES


def as_texts(option: str, said: object) -> tuple[str, ...]:
    """Return an option told in Python as the texts that `ReadOptions.choose` takes.

    ``columns`` may be a dict of columns by role, or several of ``"role=column"``; ``near`` a pair.
    """
    if option == "columns" and isinstance(said, Mapping):
        return tuple(f"{role}={column}" for role, column in said.items())
    if option == "columns" and isinstance(said, list | tuple):
        return tuple(map(str, said))
    if option == "near" and isinstance(said, list | tuple):
        return (",".join(map(str, said)),)
    return (str(said),)


def _lonlat(text: str) -> tuple[float, float]:
    try:
        lon, lat = (float(part) for part in text.split(","))
    except ValueError:
        raise SettingError(
            worded(
                "A place nearby must be written lon,lat (35.1,30.2), but it is {text!r}.", text=text
            )
        ) from None
    return lon, lat
