"""The open choices that `fieldmon study calibrate` found to fit the published figures best."""

from __future__ import annotations

from fieldmon.infestation.insects.spread import Spread
from fieldmon.studies.thesis.chapter5.open_choices import OpenChoices, StartUp

CALIBRATED = OpenChoices(
    start=StartUp(share=0.005, margin_share=0.8, depth_m=5.0, cluster_size=4.0, recorded_share=0.1),
    spread=Spread(rate_per_day=0.3, to="all"),
    sources="left",
    missed_known=True,
    map_follows=False,
    bouncy_rests=False,
    counts="infestations",
    ends="season",
    stop_s=30.0,
    row_change_s=450.0,
)
