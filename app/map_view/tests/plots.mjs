// Plots for tests.

// Return a stream of even numbers in 0..1, the same every time.
export function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

// Return plants scattered over about two hectares, as `placesOf` returns them.
export function scattered(n, lon0, lat0) {
  const next = random(3), lon = new Float64Array(n), lat = new Float64Array(n);
  const flat = Math.cos((lat0 * Math.PI) / 180), step = 3e-5;
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  for (let k = 0; k < n; k++) {
    lon[k] = lon0 + (next() * 1.5e-3) / flat;
    lat[k] = lat0 + next() * 1e-3;
    bounds[0] = Math.min(bounds[0], lon[k]); bounds[1] = Math.min(bounds[1], lat[k]);
    bounds[2] = Math.max(bounds[2], lon[k]); bounds[3] = Math.max(bounds[3], lat[k]);
  }
  const half = step / 2, wide = half / flat;
  bounds[0] -= wide; bounds[1] -= half; bounds[2] += wide; bounds[3] += half;
  return { n, lon, lat, bounds, step };
}

// Return a rectangle of plants with ranks, as a layer has them.
export function gridOf(rows, columns, ranks, { lon0 = 35.1, lat0 = 30.3, step = 3e-5 } = {}) {
  const n = rows * columns, lon = new Float64Array(n), lat = new Float64Array(n);
  const flat = Math.cos(((lat0 + (rows - 1) * step / 2) * Math.PI) / 180);
  for (let k = 0; k < n; k++) {
    lon[k] = lon0 + ((k % columns) * step) / flat;
    lat[k] = lat0 + Math.floor(k / columns) * step;
  }
  const bounds = [lon0 - step / 2 / flat, lat0 - step / 2, lon0 + ((columns - 0.5) * step) / flat, lat0 + (rows - 0.5) * step];
  return { places: { n, lon, lat, bounds, step }, ranks: Uint8Array.from(ranks) };
}

// Return a view of so many pixels a degree, north up.
export function flatView({ west = 0, north = 0, px = 1000, width = 800, height = 600, zoom = 10 } = {}) {
  return {
    width, height, zoom,
    project: ([lon, lat]) => [(lon - west) * px, (north - lat) * px],
    unproject: ([x, y]) => [west + x / px, north - y / px],
  };
}
