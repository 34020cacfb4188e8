"""Treatments as the season's file keeps them: where, with what, and how well it works there."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from datetime import date, datetime, time, timedelta
from typing import TYPE_CHECKING, Any

import numpy as np

from fieldmon.compute.digest import digest
from fieldmon.compute.units import Units
from fieldmon.compute.wording import counted
from fieldmon.decisions.doses import Dose
from fieldmon.decisions.labels import irac_groups
from fieldmon.monitoring.file import schema
from fieldmon.monitoring.file.geopackage import beside_plot, blob, geometry, touch, unpacked
from fieldmon.monitoring.file.rows_that_count import COUNTS, STANDS_BACK, TAKEN_BACK
from fieldmon.monitoring.treating.applications import Application
from fieldmon.monitoring.treating.treatment import Treatment
from fieldmon.monitoring.treating.waiting_periods import WaitingPeriod, end_of
from fieldmon.plot.local_clock import LocalClock

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Mapping, Sequence

    import shapely
    from numpy.typing import NDArray
    from shapely import MultiPolygon

    from fieldmon.plot.grid import PlantGrid

    Inside = Callable[[shapely.Geometry], NDArray[np.bool_]]

#: what the application says, by the names of its columns
_TEXTS = (
    *("operator", "reason", "machinery", "crop", "pest", "authorised_by"),
    *("active_ingredient", "weather"),
)
#: what a label may fill in, by the names of its columns
FILLED = ("waiting_days", "reentry_hours", "irac_groups")
#: a row by the names of its columns, its number (fid) among them
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class TreatedPlace:
    """Where a treatment was: its outline, its plants and its size.

    Parameters
    ----------
    area
        Outline, lon/lat.
    plants
        ``(n,)`` whether each plant was treated.
    area_ha
        Hectares of the plot that it covers; None: a file of an earlier version does not say.
    by_plant
        Whether plants were treated one by one: then they count, not the outline.
    """

    area: MultiPolygon
    plants: NDArray[np.bool_]
    area_ha: float | None
    by_plant: bool = False


@dataclass(frozen=True, eq=False)
class KeptTreatment:
    """A treatment that counts, as the season's file keeps it.

    Parameters
    ----------
    number, batch
        Its row in the layer, and the batch that undoing names.
    day, on
        Number of the day, and its date.
    place
        Where.
    efficacy
        Chance that an infested plant is clean afterwards, as it was said.
    application
        What was applied, and how.
    ended
        The moment it ended: of what was said, or the end of its day.
    clock
        Of the plot.
    groups_said
        Whether people said the mode-of-action groups; False: a label did, or nobody knows.
    """

    number: int
    batch: int
    day: int
    on: date
    place: TreatedPlace
    efficacy: float
    application: Application
    ended: datetime
    clock: LocalClock
    groups_said: bool = True

    @property
    def entered_waits(self) -> WaitingPeriod:
        """Return what has to be waited for after it, as entered; `waits` minds the label."""
        said = self.application
        return WaitingPeriod(self.ended, said.waiting_days, said.reentry_hours, self.clock)

    @property
    def believed(self) -> Treatment:
        """Return it as the belief takes it."""
        return Treatment(self.day, self.place.plants, self.efficacy, self.application.over_s)


def store(
    db: sqlite3.Connection,
    treatment: Treatment,
    said: tuple[TreatedPlace, date, Application],
    batch: int,
    clock: LocalClock,
    by_label: Sequence[str] = (),
) -> int:
    """Keep a treatment that is not there yet; return how many were new, 1 or 0.

    `said` is its place, its date and what was applied; `clock` that of the plot; `by_label` names
    what of `FILLED` a label filled in.
    """
    place = said[0]
    row = _row(treatment, said, clock)
    row["geom"] = beside_plot(db, row["geom"])
    if any(row[name] is not None for name in FILLED):
        row["by_label"] = "+".join(by_label)
    row |= {"batch": batch, "digest": digest_of(row), "undone": COUNTS}
    if any(known_by(row) & marks for marks in counting(db)):
        return 0
    db.execute(
        f"INSERT INTO treatments ({', '.join(row)}) "  # noqa: S608 - names of ours
        f"VALUES ({', '.join('?' * len(row))})",
        tuple(row.values()),
    )
    touch(db, schema.TREATMENTS.name, place.area.bounds)
    return 1


def _row(
    treatment: Treatment, said: tuple[TreatedPlace, date, Application], clock: LocalClock
) -> dict[str, Any]:
    place, on, application = said
    dose, began, ended = application.dose, application.began, application.ended
    over = on + timedelta(days=1) if application.ends_next_day else on
    return {
        "geom": blob(place.area),
        "day": treatment.day,
        "date": str(on),
        "efficacy": float(treatment.efficacy),
        "product": application.product,
        "plants": int(np.count_nonzero(place.plants)),
        "dose": None if dose is None else float(dose.value),
        "unit": None if dose is None else dose.unit,
        "water_l_ha": _real(application.water_l_ha),
        "area_ha": None if place.area_ha is None else round(place.area_ha, 4),
        "waiting_days": application.waiting_days,
        "reentry_hours": _real(application.reentry_hours),
        "irac_groups": "+".join(application.irac_groups) or None,
        "began": None if began is None else _moment(clock, on, began),
        "ended": None if ended is None else _moment(clock, over, ended),
        "zone": clock.zone or None,
        **{name: getattr(application, name) or None for name in _TEXTS},
        "of_plants": zlib.compress(np.packbits(place.plants).tobytes()) if place.by_plant else None,
        "by_label": None,
    }


def _real(value: float | None) -> float | None:
    """Return a number as it comes out of the file again."""
    return None if value is None else float(value)


def _moment(clock: LocalClock, on: date, at: time) -> str:
    """Return a local time with the offset of its zone."""
    moment = end_of(clock, on, at)
    local = clock.at(moment)
    ahead = local - moment.replace(tzinfo=None)
    minutes = round(ahead.total_seconds() / 60)
    sign = "-" if minutes < 0 else "+"
    return f"{local:%Y-%m-%dT%H:%M:%S}{sign}{abs(minutes) // 60:02d}:{abs(minutes) % 60:02d}"


def digest_of(row: Mapping[str, Any]) -> str:
    """Return the digest of a treatment's row: the same for the same treatment only.

    Of one of which only product, area and efficacy were said it is that of earlier versions.
    """
    values = tuple(row[name] for name in ("day", "date", "efficacy", "product", "plants"))
    # how large it is and in which zone follows from the rest; plants stand in the outline
    more = ("dose", "unit", "water_l_ha", *FILLED, "by_label")
    told = {name: row[name] for name in (*more, "began", "ended", *_TEXTS) if row[name] is not None}
    parts: tuple[object, ...] = (values, row["geom"])
    if told:
        parts = (*parts, tuple(sorted(told.items())))
    return digest(parts, length=24, end=b"")


def known_by(row: Mapping[str, Any]) -> frozenset[str]:
    """Return the digests by which a treatment is known again, whatever a label added to it.

    One is of all values, whoever said them, and one of what people said. Rows that share one are
    the same treatment. Where an earlier version did not note what a label added, all values count.
    """
    if row["by_label"] is None:
        return frozenset({row["digest"]})
    values = {**row, "by_label": None}
    said = values | dict.fromkeys(row["by_label"].split("+"))
    return frozenset({digest_of(values), digest_of(said)})


def but_for_labels(row: Mapping[str, Any]) -> str:
    """Return the digest of all that a treatment says but what a label may have filled in."""
    return digest_of({**row, **dict.fromkeys((*FILLED, "by_label"))})


def counting(db: sqlite3.Connection) -> list[frozenset[str]]:
    """Return what each treatment that counts is known by."""
    return [known_by(row) for row in rows_counting(db)]


def rows_counting(db: sqlite3.Connection) -> list[Row]:
    """Return the rows of the treatments that count."""
    return _rows(db, "undone = 0")


def counting_alone(db: sqlite3.Connection, other: sqlite3.Connection) -> list[tuple[str, str]]:
    """Return product and day of the treatments that count in another season, and not in this."""
    known = frozenset[str]().union(*counting(db))
    theirs = (row for row in _rows(other, "undone = 0") if known.isdisjoint(known_by(row)))
    return [(row["product"] or "", row["date"]) for row in theirs]


def counting_of(rows: Iterable[Row]) -> dict[int, frozenset[str]]:
    """Return what those of rows that count are known by, by their numbers."""
    return {row["fid"]: known_by(row) for row in rows if row["undone"] == COUNTS}


def settle(rows: Iterable[Row]) -> None:
    """Let the first of rows that are the same treatment count, and the others stand back for it."""
    counted: set[str] = set()
    for row in rows:
        if row["undone"] != TAKEN_BACK and row["digest"] is not None:
            marks = known_by(row)
            row["undone"] = STANDS_BACK if marks & counted else COUNTS
            counted |= marks if row["undone"] == COUNTS else set()


def count_again(db: sqlite3.Connection) -> list[int]:
    """Let treatments count again where none stands for them any more; return their batches."""
    rows = _rows(db, "1", "batch, fid")
    before = [row["undone"] for row in rows]
    settle(rows)
    changed = [row for row, was in zip(rows, before, strict=True) if row["undone"] != was]
    db.executemany(
        "UPDATE treatments SET undone = ? WHERE fid = ?",
        sorted(((row["undone"], row["fid"]) for row in changed), reverse=True),
    )
    return sorted({row["batch"] for row in changed})


def n_elsewhere(db: sqlite3.Connection, batch: int, only: int | None = None) -> int:
    """Return how many treatments of a batch do not count, but another row of the same does.

    `only` as in `rows_that_count.n_elsewhere`.
    """
    counted = frozenset().union(*counting(db))
    which = f"undone <> {COUNTS}" if only is None else f"undone = {only:d}"
    gone = _rows(db, f"batch = {batch:d} AND {which}")
    return sum(bool(known_by(row) & counted) for row in gone)


def _rows(db: sqlite3.Connection, which: str, order: str = "fid") -> list[Row]:
    names = ("fid", *schema.TREATMENTS.names)
    wanted = f"SELECT {', '.join(names)} FROM treatments WHERE {which} ORDER BY {order}"  # noqa: S608 - ours
    return [dict(zip(names, row, strict=True)) for row in db.execute(wanted)]


def in_words(place: TreatedPlace, application: Application, where: str) -> str:
    """Return what the season's log says of a treatment; `where` names its rows."""
    parts = [application.product or "a product that nobody named"]
    if application.dose is not None:
        parts.append(str(application.dose))
    if place.area_ha is not None:
        parts.append(f"on {Units().square(place.area_ha * 1e4)}")
    plants = counted(int(np.count_nonzero(place.plants)), "plant")
    # of a part of a row, how many plants they are stands in `where`
    return ", ".join([" ".join(parts), *([] if where.startswith(plants) else [plants]), where])


def by_vine(done: Iterable[KeptTreatment], grid: PlantGrid) -> list[KeptTreatment]:
    """Return treatments of vines, each as one plant: its two faces are sprayed together."""
    return [
        replace(one, place=replace(one.place, plants=grid.vines_of(one.place.plants)))
        for one in done
    ]


def n_vines(
    db: sqlite3.Connection, numbers: Sequence[int], inside: Inside, grid: PlantGrid
) -> dict[int, int]:
    """Return how many vines the treatments of some batches reach, by batch; two faces are one."""
    reached: dict[int, int] = {}
    batches = ", ".join(f"{number:d}" for number in numbers)
    for row in _rows(db, f"batch IN ({batches}) AND date NOTNULL"):
        plants = _kept(row, inside, LocalClock("UTC")).place.plants
        n = int(np.count_nonzero(grid.vines_of(plants)))
        reached[row["batch"]] = reached.get(row["batch"], 0) + n
    return reached


def not_what_they_say(db: sqlite3.Connection) -> list[int]:
    """Return rows whose digest is not that of what they say."""
    found = []
    for row in _rows(db, "1"):
        # a library that was told 1 and not 1.0 once kept the digest of 1
        whole = row | {"efficacy": int(row["efficacy"])}
        if row["digest"] not in {digest_of(row), digest_of(whole)}:
            found.append(row["fid"])
    return found


def kept(db: sqlite3.Connection, inside: Inside, clock: LocalClock) -> tuple[KeptTreatment, ...]:
    """Return the treatments that count, in the order in which they ended.

    `inside` tells which plants stand in an area. Where labels added different values to rows of the
    same treatment, the longer waits and all groups hold.
    """
    behind = [(known_by(row), row) for row in _rows(db, f"undone = {STANDS_BACK}")]
    rows = (_strictest(row, behind) for row in _rows(db, f"undone = {COUNTS}"))
    made = [_kept(row, inside, clock) for row in rows]
    return tuple(sorted(made, key=lambda one: (one.ended, one.number)))


def _strictest(row: Row, behind: list[tuple[frozenset[str], Row]]) -> Row:
    """Return a row with the strictest of what labels added to it and to those that stand back.

    What people said is the same in all of them.
    """
    own = known_by(row) if behind else frozenset()
    same = [row, *(one for marks, one in behind if marks & own)]
    waits = {
        name: max((one[name] for one in same if one[name] is not None), default=None)
        for name in ("waiting_days", "reentry_hours")
    }
    groups = "+".join(one["irac_groups"] for one in same if one["irac_groups"])
    return {**row, **waits, "irac_groups": groups}


def load(db: sqlite3.Connection, inside: Inside) -> tuple[Treatment, ...]:
    """Return the treatments that count as the belief takes them, as they were recorded."""
    made = kept(db, inside, LocalClock("UTC"))
    return tuple(one.believed for one in sorted(made, key=lambda one: one.number))


def _kept(row: dict[str, Any], inside: Inside, clock: LocalClock) -> KeptTreatment:
    area, on = geometry(row["geom"]), date.fromisoformat(row["date"])
    clock = LocalClock(row["zone"]) if row["zone"] else clock
    by_plant = row["of_plants"] is not None
    plants = inside(area)
    if by_plant:
        bits = np.frombuffer(unpacked(row["of_plants"], -(-len(plants) // 8)), np.uint8)
        plants = np.unpackbits(bits, count=len(plants)).astype(bool)
    began, ended = (_read(row[name]) for name in ("began", "ended"))
    more: dict[str, Any] = {name: row[name] or "" for name in _TEXTS}
    more |= {name: row[name] for name in ("water_l_ha", "waiting_days", "reentry_hours")}
    application = Application(
        product=row["product"] or "",
        dose=None if row["dose"] is None else Dose(row["dose"], row["unit"]),
        irac_groups=irac_groups(row["irac_groups"] or ""),
        began=None if began is None else began.time(),
        ended=None if ended is None else ended.time(),
        **more,
    )
    place = TreatedPlace(area, plants, row["area_ha"], by_plant)
    over = end_of(clock, on, None) if ended is None else ended
    return KeptTreatment(
        row["fid"], row["batch"], row["day"], on, place, row["efficacy"], application, over, clock,
        row["by_label"] is not None and "irac_groups" not in row["by_label"].split("+"),
    )  # fmt: skip


def _read(moment: str | None) -> datetime | None:
    return None if moment is None else datetime.fromisoformat(moment)
