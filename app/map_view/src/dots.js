// The dots of plots that are too small to be seen. Plots that would have the same dot share one, with
// their number on it, so that each of them can be reached.

export const MARKS = "plot marks";
// a dot is so large; small plots nearer to each other than this share one, and any plots that lie on each other
const ALONE_PX = 6, SHARED_PX = 10, APART_PX = 20;
// a name stands so far below its plot's dot
const BELOW = 1e-4, GAP_PX = 2 * ALONE_PX;
const NONE = { json: null, zoom: null, rows: [], shown: null };

// Return the dots of a zoom: rows of the layer's own, `of` which plots each is.
function dotsOf(plots, viewport) {
  const dots = [], cells = new Map();
  const cellOf = (v) => Math.floor(v / APART_PX);
  plots.forEach(({ p, around: [west, south, east, north] }, k) => {
    const [x, y] = viewport.project(p), [left, bottom] = viewport.project([west, south]), [right, top] = viewport.project([east, north]);
    const near = [-1, 0, 1].flatMap((i) => [-1, 0, 1].flatMap((j) => cells.get(`${cellOf(x) + i} ${cellOf(y) + j}`) ?? []));
    const small = Math.max(right - left, bottom - top) < 2 * ALONE_PX, far = (dot) => Math.hypot(dot.x - x, dot.y - y);
    const shares = (dot) => far(dot) < (small && dot.small ? APART_PX : ALONE_PX);
    const [nearest] = near.filter(shares).toSorted((a, b) => far(a) - far(b));
    if (nearest) {
      nearest.of.push(k);
      nearest.small ||= small;
    } else {
      const dot = { x, y, small, of: [k] }, cell = `${cellOf(x)} ${cellOf(y)}`;
      dots.push(dot);
      cells.set(cell, [...(cells.get(cell) ?? []), dot]);
    }
  });
  return dots.filter(({ small, of }) => small || of.length > 1).map(({ of }) => {
    const [first] = of.toSorted((a, b) => plots[a].urgent - plots[b].urgent);
    return { ...plots[first], p: plots[of[0]].p, of, r: of.length > 1 ? SHARED_PX : ALONE_PX };
  });
}

export class Dots {
  constructor() {
    this.last = NONE;
  }

  // Return the layers as they are, but with the dots of this zoom.
  of(jsons, viewport) {
    const json = jsons.find(({ id }) => id === MARKS);
    if (!json || !viewport) return jsons;
    const { zoom } = viewport;
    if (this.last.json !== json || this.last.zoom !== zoom) {
      const rows = dotsOf(json.data, viewport), same = this.last.json === json && JSON.stringify(rows) === JSON.stringify(this.last.rows);
      const shown = same ? this.last.shown : { ...json, data: rows, getRadius: "@@=r", radiusUnits: "pixels" };
      this.last = { json, zoom, rows, shown };
    }
    return jsons.map((one) => (one === json ? this.last.shown : one));
  }

  // Return the same, to be drawn.
  drawn(jsons, viewport) {
    const made = this.of(jsons, viewport);
    this.onMap = made.find(({ id }) => id === MARKS);
    return made;
  }

  // Whether the dots that were drawn are not those of this zoom.
  isStale(jsons, viewport) {
    return this.of(jsons, viewport).find(({ id }) => id === MARKS) !== this.onMap;
  }

  // Return the words on the map: how many plots share a dot instead of their names; a dot's name stands below it.
  labels(labels, jsons, viewport) {
    const json = this.of(jsons, viewport).find(({ id }) => id === MARKS);
    if (!json?.getRadius) return labels;
    const dot = new Map(json.data.flatMap((one) => one.of.map((plot) => [plot, one])));
    const numbers = json.data.filter(({ of }) => of.length > 1).map(({ p, of }) => ({ p, t: `${of.length}`, k: "plots", tight: true }));
    const names = labels.filter(({ plot }) => (dot.get(plot)?.of.length ?? 1) === 1).map((label) => {
      const [lon, lat] = label.p;
      return dot.has(label.plot) ? { ...label, away: [lon, lat - BELOW], gap: GAP_PX } : label;
    });
    return [...numbers, ...names];
  }
}

// Return the dot nearest to a place within some pixels; undefined: none.
export function dotUnder(dots, here, viewport, reachPx) {
  const [x, y] = viewport.project(here);
  const far = ({ p }) => { const [u, v] = viewport.project(p); return Math.hypot(u - x, v - y); };
  return dots.filter((dot) => dot.of && far(dot) <= reachPx).toSorted((a, b) => far(a) - far(b))[0];
}
