"""Pest records out of a layer or table: where, when, how many, whether at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fieldmon.errors import ObservationError
from fieldmon.field import PRESENT, UNKNOWN, Observations
from fieldmon.geodata.columns import find
from fieldmon.geodata.findings import (
    Finding,
    Imported,
    Remedy,
    doubtful,
    guessed,
    seen,
)
from fieldmon.geodata.layers import Layer, text
from fieldmon.geodata.positions import located
from fieldmon.geodata.values import counted, dates, dates_of_parts, decimal_mark, numbers, presence

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fieldmon.geodata.options import RecordOptions


def records_of(layer: Layer, options: RecordOptions) -> Imported[Observations]:
    """Return the records of a layer, each with a position."""
    total = len(layer)
    layer, lonlat, findings = located(layer, options)
    if len(layer) == 0:
        raise ObservationError(
            f"{layer.name} must hold records with a position, but none of its {total} has one."
        )
    day, more = _days(layer, options)
    findings += more
    count, present, more = _counts(layer, options)
    findings += more
    observations = Observations.of(
        lonlat,
        present,
        day,
        count=count,
        accuracy_m=_numbers(layer, options, "accuracy"),
        species=_texts(layer, options, "species"),
        stage=_texts(layer, options, "stage"),
        leaves_sampled=_numbers(layer, options, "leaves"),
    )
    return Imported(observations, (*layer.findings, *findings))


def _named(layer: Layer, options: RecordOptions, role: str) -> str | None:
    return options.column(role) or find(role, layer.columns)


def _numbers(layer: Layer, options: RecordOptions, role: str) -> NDArray[np.float64]:
    name = _named(layer, options, role)
    if name is None:
        return np.full(len(layer), np.nan)
    return numbers(layer.column(name), options.decimal)


def _texts(layer: Layer, options: RecordOptions, role: str) -> NDArray[np.str_]:
    name = _named(layer, options, role)
    if name is None:
        return np.full(len(layer), "", dtype=np.str_)
    return np.array([text(v) for v in layer.column(name)], dtype=np.str_)


def _days(layer: Layer, options: RecordOptions) -> tuple[NDArray[np.datetime64], list[Finding]]:
    parts = [_named(layer, options, role) for role in ("year", "month", "day")]
    name = options.column("date") or find("date", layer.columns, frozenset(p for p in parts if p))
    if name is None and all(parts):
        columns = [numbers(layer.column(str(part))) for part in parts]
        read = dates_of_parts(*columns)
        findings = [seen(f"Dates are in columns {', '.join(str(p) for p in parts)}.")]
    elif name is not None:
        read = dates(layer.column(name), options.date_order)
        findings = [seen(f"Dates are in column {name!r}.")]
    else:
        unknown = np.full(len(layer), "NaT", dtype="datetime64[D]")
        return unknown, [doubtful("No column was recognised as the date of the records.")]
    if read.is_ambiguous:
        findings.append(
            guessed(
                "Every date could be day first or month first; they were read day first.",
                name,
                Remedy("date_order", "mdy", "Read month first"),
            )
        )
    if read.n_broken:
        findings.append(
            doubtful(f"{read.n_broken} record(s) have a date that is none; it is left open.", name)
        )
    return read.day, findings


def _counts(
    layer: Layer, options: RecordOptions
) -> tuple[NDArray[np.float64], NDArray[np.int8], list[Finding]]:
    """Return how many ``(n,)``, whether ``(n,)``, and what was found."""
    n = len(layer)
    count_name = _named(layer, options, "count")
    present_name = options.column("present") or find(
        "present", layer.columns, frozenset({count_name} if count_name else ())
    )
    count, present = np.full(n, np.nan), np.full(n, UNKNOWN, dtype=np.int8)
    findings: list[Finding] = []
    if count_name is not None:
        cells = [text(v) for v in layer.column(count_name)]
        mark = options.decimal or decimal_mark(cells)
        known = {c: counted(c, mark) for c in set(cells)}
        count = np.array([known[c].number for c in cells])
        present = np.array([known[c].present for c in cells], dtype=np.int8)
        findings.append(seen(f"Counts are in column {count_name!r}."))
        rough = sum(known[c].is_rough for c in cells)
        if rough:
            findings.append(
                doubtful(f"{rough} count(s) are no plain number and were read roughly.", count_name)
            )
    if present_name is not None:
        said = {c: presence(c) for c in {text(v) for v in layer.column(present_name)}}
        stated = np.array([said[text(v)] for v in layer.column(present_name)], dtype=np.int8)
        present = np.where(stated == UNKNOWN, present, stated).astype(np.int8)
        findings.append(seen(f"Presence is in column {present_name!r}."))
    if count_name is None and present_name is None:
        present[:] = PRESENT
        findings.append(
            guessed("No column says how many or whether: every record was taken as a find.")
        )
    return count, present, findings
