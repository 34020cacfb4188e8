"""Lengths, areas and dates: the library's own, which reports are written with too."""

from __future__ import annotations

from fieldmon.compute.units import AREAS_M2, DATES, LENGTHS, Units

__all__ = ["AREAS_M2", "DATES", "LENGTHS", "Units"]
