"""Whether a line crosses a row of plants: an oracle that knows nothing of the road network."""

import numpy as np
import shapely

from fieldmon.plot.obstacles import row_lines

_TOUCH_M = 0.01


def crosses_rows(grid, line_xy_m):
    """Tell whether a line ``(k, 2)`` comes within a centimetre of a row.

    A row is the line through its plants, from the first to the last; see `row_lines`.
    """
    # not by distance: to lines of no length, as a row of one plant is, GEOS finds none
    rows = shapely.STRtree(shapely.buffer(row_lines(grid), _TOUCH_M))
    steps = shapely.linestrings(np.stack([line_xy_m[:-1], line_xy_m[1:]], axis=1))
    return bool(rows.query(steps, predicate="intersects").size)
