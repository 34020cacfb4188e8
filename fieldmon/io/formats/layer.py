"""What every vector file and every table becomes first: geometry, columns, a coordinate system."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np
import shapely

from fieldmon.compute.wording import worded
from fieldmon.errors import ChoiceNeeded
from fieldmon.io.import_report import dropped, seen
from fieldmon.io.parse.columns import find, recognised
from fieldmon.io.parse.pest_names import pest_key

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from fieldmon.io.import_report import ImportMessage

#: longitude, then latitude: the coordinate system of files that name none and have no other
WGS84 = "OGC:CRS84"


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer or table, as the file has it: nothing transformed, nothing repaired.

    Parameters
    ----------
    name
        Of the layer or sheet, or of the file as it is called, with its ending.
    columns
        Name -> ``(n,)`` values: text, numbers, or None.
    geometry
        ``(n,)`` shapely geometries or None, in the file's coordinates; None for a table.
    crs
        As the file states it (authority code, WKT or PROJJSON); None where it does not.
    messages
        What reading it had to say.
    above
        What stands above the column names of a table.
    stem
        Of a file its name without ending; empty: `name` has none.
    """

    name: str
    columns: dict[str, NDArray[np.object_]]
    geometry: NDArray[np.object_] | None = None
    crs: str | None = None
    messages: tuple[ImportMessage, ...] = ()
    above: str = ""
    stem: str = ""

    @property
    def plot_name(self) -> str:
        """Return what a plot in it is called that has no name of its own."""
        return self.stem or self.name

    def __len__(self) -> int:
        """Return the number of features or records."""
        if self.geometry is not None:
            return len(self.geometry)
        return len(next(iter(self.columns.values()), ()))

    def take(self, which: NDArray[np.generic]) -> Layer:
        """Return the features at the given indices or mask."""
        return Layer(
            self.name,
            {name: values[which] for name, values in self.columns.items()},
            None if self.geometry is None else self.geometry[which],
            self.crs,
            self.messages,
            self.above,
            self.stem,
        )

    def saying(self, *more: ImportMessage) -> Layer:
        """Return the same layer with more messages."""
        return replace(self, messages=(*self.messages, *more))

    def checked(self) -> Layer:
        """Return the layer flat, without geometries whose coordinates are no numbers."""
        if self.geometry is None:
            return self
        messages = []
        if shapely.has_z(self.geometry).any() or shapely.has_m(self.geometry).any():
            messages.append(seen(worded("Heights and measures (Z, M) are not used.")))
        flat = shapely.force_2d(self.geometry)
        coordinates, feature = shapely.get_coordinates(flat, return_index=True)
        broken = np.unique(feature[~np.isfinite(coordinates).all(axis=1)])
        flat[broken] = None
        if len(broken):
            said = worded(
                "{n} {n:feature has|features have} coordinates that are no numbers; left out.",
                n=len(broken),
            )
            messages.append(dropped(said, f"feature {broken[0] + 1}"))
        return replace(self, geometry=flat, messages=(*self.messages, *messages))

    def where(self, condition: str | None, pests: Collection[str] = ()) -> Layer:
        """Return the features that fulfil ``column=value``; all of them for None.

        A pest is meant in all its spellings, where the column is called so or is one of `pests`.
        """
        if condition is None:
            return self
        column, _, value = condition.partition("=")
        try:
            named = self.column(column.strip())
        except ChoiceNeeded as asked:
            like = self._with_value(value.strip())
            offers = tuple(f"{name}={value.strip()}" for name in like or asked.choices)
            raise ChoiceNeeded(asked.args[0], "where", offers) from None
        of_pests = find("species", [column.strip()]) or column.strip() in pests
        key = pest_key if of_pests else str
        kept = np.array([key(text(v)) == key(value.strip()) for v in named], dtype=bool)
        if not kept.any():
            offers = tuple(f"{column}={v}" for v in sorted({text(v) for v in named})[:50])
            raise ChoiceNeeded(
                worded(
                    "The choice {condition!r} must fit at least one feature, "
                    "but it fits none. Column {column} holds: {names}.",
                    condition=condition,
                    column=column,
                    names=", ".join(o.partition("=")[2] for o in offers[:10]),
                ),
                "where",
                offers,
            )
        return self.take(kept)

    def _with_value(self, value: str) -> list[str]:
        """Return the columns that hold a value."""
        return [n for n, values in self.columns.items() if any(text(v) == value for v in values)]

    def with_roles(self, columns: tuple[tuple[str, str], ...]) -> Self:
        """Return the same layer; ask where a column that was named by hand is not there."""
        for role, name in columns:
            try:
                if name:
                    self.column(name)
            except ChoiceNeeded as asked:
                self._must_name_one(role, name)
                taken = {other.casefold() for _, other in columns}
                free = [own for own in asked.choices if own.casefold() not in taken]
                fits = [own for own in free if find(role, [own]) or not recognised([own])]
                offers = tuple(f"{role}={own}" for own in fits or asked.choices)
                raise ChoiceNeeded(asked.args[0], "columns", offers) from None
        return self

    def _must_name_one(self, role: str, name: str) -> None:
        """Say how to name several columns to who names them at once: ``count=A,present=B``."""
        several = re.split(r",\s*(?=[a-z]+=)", f"{role}={name}")
        if len(several) == 1:
            return
        known = {own.casefold(): own for own in self.columns}
        offer = known.get(several[0].partition("=")[2].casefold())
        raise ChoiceNeeded(
            worded(
                "Each column must be named by itself, but {name!r} names {n}. Give the option once "
                "for each: {each}.",
                name=f"{role}={name}",
                n=len(several),
                each=", ".join(f"columns={one}" for one in several),
            ),
            "columns",
            () if offer is None else (f"{role}={offer}",),
        )

    def column(self, name: str) -> NDArray[np.object_]:
        """Return a column by its name, capitals aside; raise `ChoiceNeeded` where there is none."""
        if name in self.columns:
            return self.columns[name]
        for own, values in self.columns.items():
            if own.casefold() == name.casefold():
                return values
        raise ChoiceNeeded(
            worded(
                "There must be a column {name!r}, but the columns are {value}. Choose one of them.",
                name=name,
                value=", ".join(self.columns) or "none at all",
            ),
            "columns",
            tuple(self.columns),
        )


def text(value: object) -> str:
    """Return a cell as the text a person would see; empty for a missing one."""
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value).strip()


class LayerInfo(NamedTuple):
    """One layer that a source holds.

    Parameters
    ----------
    member
        File in the archive or folder; hand it back as ``options.member``.
    layer
        Layer or sheet; hand it back as ``options.layer``.
    geometry_type
        As the file states it; None for a plain table.
    """

    member: str
    layer: str
    geometry_type: str | None
