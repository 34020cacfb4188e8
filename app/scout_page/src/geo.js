// Where things are on the plot: degrees to metres, nearest plants, neighbours, ways between them.

const A = 6378137, E2 = 0.00669437999014; // WGS 84

/** Metres per degree of longitude and of latitude at a latitude. */
export function metresPerDegree(lat) {
  const s = Math.sin((lat * Math.PI) / 180), w = 1 - E2 * s * s, turn = Math.PI / 180;
  return [(A / Math.sqrt(w)) * Math.cos((lat * Math.PI) / 180) * turn, ((A * (1 - E2)) / w ** 1.5) * turn];
}

/** What the phone keeps of the plot's document: plants in metres east and north of its middle. */
export function laidOut(document, digest) {
  const { lon, lat, number, face, drawn_lon, drawn_lat } = document.plants;
  const lon0 = (low(lon) + high(lon)) / 2, lat0 = (low(lat) + high(lat)) / 2;
  const [kx, ky] = metresPerDegree(lat0);
  const east = (some) => Float32Array.from(some, (one) => (one - lon0) * kx), north = (some) => Float32Array.from(some, (one) => (one - lat0) * ky);
  const plot = {
    digest, name: document.name, zone: document.zone, lon0, lat0, kx, ky, x: east(lon), y: north(lat),
    // where faces are drawn: each towards its aisle, as both have one place
    drawn: drawn_lon && { x: east(drawn_lon), y: north(drawn_lat) },
    number: Int32Array.from(number), face: face && Int8Array.from(face), start: Int32Array.from(document.rows.start),
    row: Int32Array.from(document.rows.row), sign: document.rows.sign, aisle: Int32Array.from(document.rows.aisle), side: Int8Array.from(document.rows.side),
    rowSpacing: document.row_spacing_m, plantSpacing: document.plant_spacing_m,
  };
  plot.gate = document.gate && metres(plot, document.gate);
  plot.boundary = rings(document.boundary).map((ring) => ring.map((at) => metres(plot, at)));
  return plot;
}

const low = (values) => values.reduce((a, b) => (b < a ? b : a), Infinity);
const high = (values) => values.reduce((a, b) => (b > a ? b : a), -Infinity);

/** The rings of a GeoJSON polygon or of several. */
export function rings(geometry) {
  if (geometry.type === "Polygon") return geometry.coordinates;
  if (geometry.type === "MultiPolygon") return geometry.coordinates.flat();
  return (geometry.geometries ?? []).flatMap(rings);
}

export const metres = (plot, [lon, lat]) => [(lon - plot.lon0) * plot.kx, (lat - plot.lat0) * plot.ky];

/** Piece of row in which a plant stands. */
export function pieceOf(plot, plant) {
  let a = 0, b = plot.start.length - 1;
  while (b - a > 1) { const m = (a + b) >> 1; if (plot.start[m] <= plant) a = m; else b = m; }
  return a;
}

export const rowOf = (plot, plant) => plot.row[pieceOf(plot, plant)];

/** How the row of a plant is shown; a plot kept by an earlier version has numbers alone. */
export const signOf = (plot, plant) => signAt(plot, pieceOf(plot, plant));
const signAt = (plot, k) => plot.sign?.[k] ?? `${plot.row[k]}`;

/** How rows from one number to another are shown. */
export const shownEnds = (plot, ends) => ends.map((row) => { const k = plot.row.indexOf(row); return k < 0 ? row : signAt(plot, k); });

/** Whether a row of the plot has a name that says more than its number. */
export const hasNames = (plot) => Boolean(plot.sign?.some((sign) => /\D/.test(sign)));

// capitals and zeros in front do not matter
const key = (name) => name.trim().toLowerCase().replace(/0*(\d+)/g, "$1");

/** The numbers of the rows that somebody may mean, by their number or by their name. */
export function rowsCalled(plot, said) {
  const called = (row, k) => [`${row}`, signAt(plot, k).slice(`${row} · `.length)];
  return [...new Set(plot.row.filter((row, k) => called(row, k).some((one) => one && key(one) === key(said))))];
}

const lines = new WeakMap();
/** The line of each piece of a row, in their order on the ground: what rows are called says nothing of it. */
export function linesOf(plot) {
  let line = 0;
  if (!lines.has(plot)) lines.set(plot, plot.row.map((row, k) => (k && row !== plot.row[k - 1] ? ++line : line)));
  return lines.get(plot);
}

const twins = new WeakMap();
/** The other face of a plant that has two, which stands in the same place, or -1. */
export function twinOf(plot, plant) {
  if (!plot.face?.[plant]) return -1;
  if (!twins.has(plot)) twins.set(plot, inPairs(plot));
  return twins.get(plot)[plant];
}

function inPairs({ x, y, face }) {
  const twin = new Int32Array(x.length).fill(-1), first = new Map();
  for (let i = 0; i < x.length; i++) {
    const place = `${x[i]} ${y[i]}`, other = face[i] ? first.get(place) : undefined;
    if (other !== undefined) { twin[i] = other; twin[other] = i; } else if (face[i]) first.set(place, i);
  }
  return twin;
}

/** Where the aisle of a face is on the map, north up: an arrow; none where that is not known. */
export function arrowOf({ x, y, drawn }, plant) {
  if (!drawn) return "";
  const turn = Math.atan2(drawn.y[plant] - y[plant], drawn.x[plant] - x[plant]);
  return "→↗↑↖←↙↓↘"[Math.round(turn / (Math.PI / 4)) & 7];
}

/** The plant with a row and a number as people count, its first face where it has two, or -1. */
export function plantAt(plot, row, number) {
  for (let k = 0; k < plot.row.length; k++) {
    if (plot.row[k] !== row) continue;
    for (let i = plot.start[k]; i < plot.start[k + 1]; i++) if (plot.number[i] === number) return i;
  }
  return -1;
}

/** The plant nearest to a place, its first face where it has two, and how far it is. */
export function nearest(plot, x, y) {
  let best = Infinity, plant = -1;
  for (let i = 0; i < plot.x.length; i++) {
    const dx = plot.x[i] - x, dy = plot.y[i] - y, d = dx * dx + dy * dy;
    if (d < best) { best = d; plant = i; }
  }
  return { plant, metres: Math.sqrt(best) };
}

export function apart(plot, a, b) { return Math.hypot(plot.x[a] - plot.x[b], plot.y[a] - plot.y[b]); }

/** Which plant a position offers: the nearest, and only if it is within the position's accuracy. */
export function offered(plot, position) {
  if (!position) return -1;
  const found = nearest(plot, position.x, position.y);
  return found.metres <= position.accuracy ? found.plant : -1;
}

/** The plants next to one: in its row, and across in the rows on both sides, or its other face where rows have two, as the season has them. */
export function neighbours(plot, plant) {
  const piece = pieceOf(plot, plant), line = linesOf(plot), found = [];
  if (plant > plot.start[piece]) found.push(plant - 1);
  if (plant + 1 < plot.start[piece + 1]) found.push(plant + 1);
  if (plot.face) {
    const twin = twinOf(plot, plant);
    return twin < 0 ? found : [...found, twin];
  }
  for (const side of [-1, 1]) {
    let best = 1.5 * plot.rowSpacing, across = -1;
    for (let k = 0; k < plot.row.length; k++) {
      if (line[k] !== line[piece] + side) continue;
      for (let i = plot.start[k]; i < plot.start[k + 1]; i++) {
        const d = apart(plot, plant, i);
        if (d < best) { best = d; across = i; }
      }
    }
    if (across >= 0) found.push(across);
  }
  return found;
}

/** Metres from a plant to a place outside the rows: by the nearer end of its row. */
export function metresOut(plot, plant, [x, y]) {
  const piece = pieceOf(plot, plant), ends = [plot.start[piece], plot.start[piece + 1] - 1];
  return Math.min(...ends.map((end) => apart(plot, plant, end) + Math.hypot(plot.x[end] - x, plot.y[end] - y)));
}

/** Seconds of the way between two plants; nobody walks through a row. */
export function walkSeconds(plot, robot, a, b) {
  if (a < 0 || b < 0) return 0;
  const from = pieceOf(plot, a), to = pieceOf(plot, b), speed = robot.speed_m_s;
  if (from === to || plot.aisle[from] === plot.aisle[to]) return apart(plot, a, b) / speed;
  const ends = [(k) => plot.start[k], (k) => plot.start[k + 1] - 1];
  const ways = ends.map((end) => apart(plot, a, end(from)) + apart(plot, end(from), end(to)) + apart(plot, end(to), b));
  return Math.min(...ways) / speed + robot.row_change_s;
}
