// What lies under the pointer, looked up in the data: no second drawing of the map is needed.

// Return the plant nearest to a place within some metres, or -1. The index is made once a plot.
export function nearestPlant(places, [lon, lat], reachM) {
  const index = (places.index ??= indexOf(places));
  const { west, south, flat, cell, wide, tall, starts, order } = index, reach = reachM / 111320;
  const clip = (value, most) => Math.max(0, Math.min(most - 1, Math.floor(value)));
  const x0 = clip(((lon - west) * flat - reach) / cell, wide), x1 = clip(((lon - west) * flat + reach) / cell, wide);
  const y0 = clip((lat - south - reach) / cell, tall), y1 = clip((lat - south + reach) / cell, tall);
  let best = -1, least = reach * reach;
  for (let y = y0; y <= y1; y++) {
    for (let at = starts[y * wide + x0]; at < starts[y * wide + x1 + 1]; at++) {
      const k = order[at];
      const east = (places.lon[k] - lon) * flat, north = places.lat[k] - lat;
      const far = east * east + north * north;
      if (far <= least) { least = far; best = k; }
    }
  }
  return best;
}

function indexOf({ n, lon, lat, bounds, step }) {
  const [west, south, east, north] = bounds;
  const flat = Math.cos((((south + north) / 2) * Math.PI) / 180);
  const cell = Math.max(2 * step, (east - west) * flat / 1000, (north - south) / 1000);
  const wide = Math.ceil(((east - west) * flat) / cell) + 1, tall = Math.ceil((north - south) / cell) + 1;
  const starts = new Uint32Array(wide * tall + 1), order = new Uint32Array(n);
  const cellOf = (k) => Math.floor((lat[k] - south) / cell) * wide + Math.floor(((lon[k] - west) * flat) / cell);
  for (let k = 0; k < n; k++) starts[cellOf(k) + 1]++;
  for (let c = 0; c < wide * tall; c++) starts[c + 1] += starts[c];
  const next = starts.slice();
  for (let k = 0; k < n; k++) order[next[cellOf(k)]++] = k;
  return { west, south, flat, cell, wide, tall, starts, order };
}

// Return whether a place is within a ring.
export function within([lon, lat], ring) {
  let inside = false;
  for (let k = 0, j = ring.length - 1; k < ring.length; j = k++) {
    const [x1, y1] = ring[k], [x2, y2] = ring[j];
    if (y1 > lat !== y2 > lat && lon < ((x2 - x1) * (lat - y1)) / (y2 - y1) + x1) inside = !inside;
  }
  return inside;
}

// Return the plants within a ring, as their numbers.
export function plantsWithin(places, ring) {
  const found = [];
  for (let k = 0; k < places.n; k++) if (within([places.lon[k], places.lat[k]], ring)) found.push(k);
  return found;
}

// Return the rows of a layer's data under the pointer that say something, the last drawn first: points, and
// areas by their ring, or by their rings with holes.
export function rowsUnder(rows, here, reachM) {
  const flat = Math.cos((here[1] * Math.PI) / 180), found = [];
  for (let k = rows.length - 1; k >= 0; k--) {
    const { p, t } = rows[k];
    if (!t || !p) continue;
    const rings = Array.isArray(p[0]) && (Array.isArray(p[0][0]) ? p : [p]);
    const far = rings || Math.hypot((p[0] - here[0]) * flat, p[1] - here[1]) * 111320;
    if (rings ? rings.filter((ring) => within(here, ring)).length % 2 : far <= reachM) found.push(k);
  }
  return found;
}

// Return what is said of a plant: where it stands, what is believed of it, and what is known of it.
export function tipOf({ places, ranks, values, notes, tips }, k) {
  const note = tips.values ? chanceOf(tips, values[k]) : tips.ranks?.[ranks[k]] ?? "";
  const number = places.number[k], face = tips.faces && places.face?.[k];
  const plant = face ? tips.faces.replace("{number}", number).replace("{face}", face) : number;
  const known = { row: tips.rows?.[places.row[k]] ?? places.row[k], plant, note };
  const said = tips.text.replace(/\{(\w+)\}/g, (_, name) => known[name]);
  return notes && tips.notes?.[notes[k]] ? `${said}\n${tips.notes[notes[k]]}` : said;
}

// Return a chance in words, with its interval where the level of all chances may be off: `tips.odds`
// is what every plant's odds are multiplied by at the ends of it, `tips.half` how the language writes 50.0 %.
function chanceOf({ values, between, odds, least, most, half = "50.0 %" }, chance) {
  const [, mark, sign] = /^50(.)0(.*)$/.exec(half) ?? ["", ".", " %"];
  const isNumber = (share) => share >= 0.0005 && share < 0.9995;
  const number = (share) => (100 * share).toFixed(1).replace(".", mark);
  // none is said to be nothing or all
  const said = (share) => (isNumber(share) ? number(share) + sign : share < 0.5 ? least : most);
  const [low, high] = (odds ?? [1, 1]).map((by) => (chance * by) / (1 - chance + chance * by));
  const text = between && said(low) !== said(high) ? between : values;
  // two numbers share a sign
  const from = isNumber(low) && isNumber(high) ? number(low) : said(low);
  return text.replace("{chance}", said(chance)).replace("{low}", from).replace("{high}", said(high));
}
