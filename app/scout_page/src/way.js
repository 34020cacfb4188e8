// The way between plants as it is gone: along aisles and round the ends of rows, never through a row.

import { apart, linesOf, pieceOf } from "./geo.js";

const sides = new WeakMap(), said = new WeakMap();

/** The line ahead, metres: what the server drew where it goes the same legs, else round the ends of rows. */
export function wayAhead(plot, day, at, ahead) {
  const drawn = legsDrawn(plot, day.route), line = [];
  let here = at;
  for (const plant of ahead) {
    const leg = drawn.get(`${here} ${plant}`) ?? (here < 0 ? [aisleOf(plot, plant)] : around(plot, here, plant));
    line.push(...leg);
    here = plant;
  }
  return ahead.length ? [...line, ...(drawn.get(`${here} -1`) ?? [])] : line;
}

/** The legs of the day's line by the plants at their ends; -1 is where the route begins and ends. */
function legsDrawn(plot, route) {
  if (said.has(route)) return said.get(route);
  const found = new Map(), { plants, line, stops = [] } = route;
  const points = line.map(([lon, lat]) => [(lon - plot.lon0) * plot.kx, (lat - plot.lat0) * plot.ky]);
  let here = -1, from = 0;
  stops.forEach((to, k) => { found.set(`${here} ${plants[k]}`, points.slice(from, to + 1)); [here, from] = [plants[k], to]; });
  if (stops.length && from + 1 < points.length) found.set(`${here} -1`, points.slice(from));
  said.set(route, found);
  return found;
}

/** The line from one plant to another, in the aisles that they stand at. */
export function around(plot, a, b) {
  const from = pieceOf(plot, a), to = pieceOf(plot, b);
  if (from === to) return along(plot, a, b);
  if (plot.aisle[from] === plot.aisle[to]) return [...along(plot, a, beside(plot, from, b)), aisleOf(plot, b)];
  const ends = [[plot.start[from], plot.start[to]], [plot.start[from + 1] - 1, plot.start[to + 1] - 1]];
  const far = ends.map(([one, other]) => apart(plot, a, one) + apart(plot, one, other) + apart(plot, other, b));
  const last = far[1] < far[0], [one, other] = ends[Number(last)];
  return [...along(plot, a, one), ...headland(plot, [one, other], last), ...along(plot, other, b)];
}

/** Past the ends of two rows, and of those on the way between that reach farther out. */
function headland(plot, [one, other], last) {
  const out = outward(plot, one, last), begin = beyond(plot, one, out), end = beyond(plot, other, out);
  const line = linesOf(plot), rows = [one, other].map((plant) => line[pieceOf(plot, plant)]), low = Math.min(...rows), high = Math.max(...rows);
  const dot = (p, q) => p[0] * q[0] + p[1] * q[1], square = [-out[1], out[0]];
  const across = [end[0] - begin[0], end[1] - begin[1]];
  const between = [];
  for (let k = 0; k < plot.row.length; k++) {
    if (line[k] < low || line[k] > high) continue;
    const plant = last ? plot.start[k + 1] - 1 : plot.start[k], by = plot.rowSpacing / 2;
    const at = [plot.x[plant] + out[0] * by, plot.y[plant] + out[1] * by], gone = [at[0] - begin[0], at[1] - begin[1]];
    const share = dot(gone, square) / dot(across, square), more = dot(gone, out) - share * dot(across, out);
    if (share > 0 && share < 1 && more > 0) between.push([share, at]);
  }
  return [begin, ...between.sort((p, q) => p[0] - q[0]).map(([, at]) => at), end];
}

/** The aisle's line beside the plants of one piece of a row, from one to the other. */
function along(plot, a, b) {
  const line = [], step = a <= b ? 1 : -1;
  for (let plant = a; plant !== b; plant += step) line.push(aisleOf(plot, plant));
  return [...line, aisleOf(plot, b)];
}

/** The plant of a piece of a row that stands nearest to another plant. */
function beside(plot, piece, plant) {
  let best = Infinity, found = -1;
  for (let i = plot.start[piece]; i < plot.start[piece + 1]; i++) {
    const d = apart(plot, i, plant);
    if (d < best) { best = d; found = i; }
  }
  return found;
}

/** The direction, of length 1, in which a row leaves its plants at one of its ends. */
function outward(plot, end, last) {
  const piece = pieceOf(plot, end), other = last ? plot.start[piece] : plot.start[piece + 1] - 1;
  const far = apart(plot, end, other);
  if (far > 0) return [(plot.x[end] - plot.x[other]) / far, (plot.y[end] - plot.y[other]) / far];
  const [x, y] = rowDirection(plot, piece);
  return last ? [x, y] : [-x, -y];
}

function beyond(plot, plant, [ux, uy]) {
  const [x, y] = aisleOf(plot, plant), by = plot.rowSpacing / 2;
  return [x + ux * by, y + uy * by];
}

function aisleOf(plot, plant) {
  const [x, y] = sideOf(plot, pieceOf(plot, plant)), by = plot.rowSpacing / 2;
  return [plot.x[plant] + x * by, plot.y[plant] + y * by];
}

/** The direction from a piece of a row to its aisle, square to the row, of length 1. */
function sideOf(plot, piece) {
  if (!sides.has(plot)) sides.set(plot, new Map());
  const known = sides.get(plot);
  if (!known.has(piece)) known.set(piece, side(plot, piece));
  return known.get(piece);
}

function side(plot, piece) {
  const left = plot.side?.[piece] ?? 1, [x, y] = rowDirection(plot, piece);
  return [-y * left, x * left];
}

/** The direction of a row, of length 1; of one plant alone that of the row nearest to it that has more. */
function rowDirection(plot, piece) {
  for (let k = 0; k < plot.row.length; k++) {
    for (const other of [piece - k, piece + k]) {
      if (other < 0 || other >= plot.row.length) continue;
      const first = plot.start[other], last = plot.start[other + 1] - 1, far = apart(plot, first, last);
      if (far > 0) return [(plot.x[last] - plot.x[first]) / far, (plot.y[last] - plot.y[first]) / far];
    }
  }
  return [1, 0];
}
