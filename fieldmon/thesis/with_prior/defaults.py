"""The open choices that `fieldmon study calibrate` found to fit the published figures best."""

from __future__ import annotations

from fieldmon.spread import Spread
from fieldmon.thesis.with_prior.choices import OpenChoices, StartUp

CALIBRATED = OpenChoices(start=StartUp(), spread=Spread(0.5, "one"))
