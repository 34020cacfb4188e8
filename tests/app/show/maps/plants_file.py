"""Write the plants that the map's own tests read: ``python -m tests.app.show.maps.plants_file``."""

import base64
import json

import numpy as np

from app.show.maps import colours, plant_layers
from fieldmon.plot.layout import rectangle
from tests.app.shown_plants import plants_in
from tests.paths import ROOT

ROWS, PLANTS = 7, 9

if __name__ == "__main__":
    grid = rectangle(ROWS, PLANTS)
    layer = plant_layers.plants(grid, colours.plain(len(grid)))
    shown = plants_in(layer)
    step = float(np.frombuffer(layer.arrays["places"], "<f8", 4)[3])
    written = {
        "rows": ROWS,
        "plants": PLANTS,
        "places": base64.b64encode(layer.arrays["places"]).decode(),
        "lonlat": shown.lonlat.tolist(),
        "row": shown.row.tolist(),
        "number": shown.number.tolist(),
        "step": step,
    }
    to = ROOT / "app" / "map_view" / "tests" / "plants.json"
    to.write_text(json.dumps(written) + "\n", encoding="utf-8")
