// What the server has made for the map, each thing fetched once under the digest of its content.

const kept = new Map();
const MOST = 200;

function once(url, read) {
  if (!kept.has(url)) {
    const got = fetch(url).then((answer) => {
      if (!answer.ok) throw Object.assign(new Error(`${url}: ${answer.status}`), { gone: answer.status === 404 });
      return read(answer);
    });
    got.catch(() => kept.delete(url));
    kept.set(url, got);
    if (kept.size > MOST) kept.delete(kept.keys().next().value);
  } else {
    const got = kept.get(url);
    kept.delete(url); // the ones used last go last
    kept.set(url, got);
  }
  return kept.get(url);
}

const FIRST_PAUSE_MS = 200, LONGEST_PAUSE_MS = 8000;
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

// Return what `fetched` brings, asked again after ever longer pauses until it is there: the network may fail
// for a moment, and `gone` lets the server make what it had let go of. Null once it is no longer `wanted`.
export async function persist(fetched, wanted, gone, rest = pause) {
  for (let ms = FIRST_PAUSE_MS; ; ms = Math.min(2 * ms, LONGEST_PAUSE_MS)) {
    try {
      const got = await fetched();
      return wanted() ? got : null;
    } catch (error) {
      if (!wanted()) return null;
      if (error.gone) gone();
    }
    await rest(ms);
    if (!wanted()) return null;
  }
}

export const json = (url) => once(url, (answer) => answer.json());
const places = (url) => once(url, async (answer) => placesOf(await answer.arrayBuffer()));
const picture = (url) => once(url, async (answer) => createImageBitmap(await answer.blob()));
const bytes = (url) => once(url, async (answer) => new Uint8Array(await answer.arrayBuffer()));

// Return a layer's JSON, with the arrays it names in place of their addresses.
export async function layer({ url, places: where, ranks, values, notes, image }) {
  const [made, placed, ranked, valued, noted, seen] = await Promise.all([
    json(url), where && places(where), ranks && bytes(ranks), values && bytes(values), notes && bytes(notes),
    image && picture(image),
  ]);
  if (seen) return together(made, { image: seen });
  if (!placed) return made;
  const share = valued && new Float32Array(valued.buffer), said = noted && new Uint16Array(noted.buffer);
  return together(made, { places: placed, ranks: ranked, values: share, notes: said });
}

const whole = new WeakMap();

// one and the same object for the same parts: what is made of it is then made once
function together(made, parts) {
  const known = whole.get(made);
  if (known && Object.entries(parts).every(([name, part]) => known[name] === part)) return known;
  const new_ = { ...made, ...parts };
  whole.set(made, new_);
  return new_;
}

// Plants' places: a head of six doubles (n, lon, lat, step in degrees of latitude, 1 where plants have two
// faces, 0); then offsets of lon and lat as floats, rows, numbers in the row and these faces as integers, n each.
export function placesOf(buffer) {
  const [n, lon0, lat0, step, faced] = new Float64Array(buffer, 0, 6);
  const part = (Kind, at) => new Kind(buffer, 48 + 4 * n * at, n);
  const east = part(Float32Array, 0), north = part(Float32Array, 1);
  const lon = new Float64Array(n), lat = new Float64Array(n);
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  for (let k = 0; k < n; k++) {
    lon[k] = lon0 + east[k];
    lat[k] = lat0 + north[k];
    bounds[0] = Math.min(bounds[0], lon[k]);
    bounds[1] = Math.min(bounds[1], lat[k]);
    bounds[2] = Math.max(bounds[2], lon[k]);
    bounds[3] = Math.max(bounds[3], lat[k]);
  }
  const half = step / 2, wide = half / Math.cos((lat0 * Math.PI) / 180);
  bounds[0] -= wide; bounds[1] -= half; bounds[2] += wide; bounds[3] += half;
  return { n, lon, lat, bounds, step, row: part(Int32Array, 2), number: part(Int32Array, 3), face: faced ? part(Int32Array, 4) : null };
}
