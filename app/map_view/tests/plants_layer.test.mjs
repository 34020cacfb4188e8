// Plants as points and as a picture: in the colours of their ranks, where they are.

import assert from "node:assert/strict";
import { test } from "node:test";

import { filled, halved, inView, painted, pictureOf, pointsOf, ranksOf } from "../src/plants_layer.js";
import { gridOf, random, scattered } from "./plots.mjs";

const TABLE = [[10, 20, 30, 40], [50, 60, 70, 255], [200, 100, 50, 255]];

function some(rows, columns) {
  const next = random(5);
  return { ...gridOf(rows, columns, Array.from({ length: rows * columns }, () => (next() < 0.9 ? 0 : next() < 0.7 ? 1 : 2))), table: TABLE };
}

test("points have their plants' places and colours, and higher ranks come last and so on top", () => {
  const plants = some(9, 11), { length, attributes } = pointsOf(plants, null);
  assert.equal(length, 99);
  const { value: at } = attributes.getPosition, { value: colour } = attributes.getFillColor;
  const drawn = new Map();
  let before = -1;
  for (let k = 0; k < length; k++) {
    const rank = TABLE.findIndex((c) => c.every((v, i) => v === colour[4 * k + i]));
    assert.ok(rank >= before, "a plant of lesser rank covers one of a higher");
    before = rank;
    drawn.set(`${at[2 * k]} ${at[2 * k + 1]}`, rank);
  }
  assert.equal(before, 2);
  for (let k = 0; k < 99; k++) assert.equal(drawn.get(`${plants.places.lon[k]} ${plants.places.lat[k]}`), plants.ranks[k]);
});

test("of plants in view, only those are points", () => {
  const plants = some(5, 6), { length, attributes } = pointsOf(plants, [7, 3, 21]);
  assert.equal(length, 3);
  const lons = [...attributes.getPosition.value].filter((_, k) => k % 2 === 0);
  assert.deepEqual(lons.sort(), [7, 3, 21].map((k) => plants.places.lon[k]).sort());
});

test("in view is what lies within the bounds; of very many, nobody counts on", () => {
  const places = scattered(3000, 35.1, 30.3), [west, south, east, north] = places.bounds;
  const half = [west, south, (west + east) / 2, north];
  const wanted = [...places.lon.keys()].filter((k) => places.lon[k] <= half[2]);
  assert.deepEqual(inView(places, half), wanted);
  assert.deepEqual(inView(places, [0, 0, 1, 1]), []);
  const n = 60001, many = { n, lon: new Float64Array(n), lat: new Float64Array(n) };
  assert.equal(inView(many, [-1, -1, 1, 1]), null);
});

test("each pixel of a picture shows the most important plant on it, and nothing where none is", () => {
  const plants = some(40, 50);
  // a plot with a gap: no plant, no colour
  const keep = [...plants.ranks.keys()].filter((k) => k % 50 < 20 || k % 50 > 29);
  const places = { ...plants.places, n: keep.length, lon: plants.places.lon.filter((_, k) => keep.includes(k)),
                   lat: plants.places.lat.filter((_, k) => keep.includes(k)), step: 2.5 * plants.places.step };
  const ranks = Uint8Array.from(keep, (k) => plants.ranks[k]);
  const { image: { width, height, data }, bounds } = pictureOf({ places, ranks, table: TABLE });
  places.bounds.forEach((edge, k) => {
    const pixel = (bounds[2 + (k % 2)] - bounds[k % 2]) / [width, height][k % 2];
    const beyond = (k < 2 ? edge - bounds[k] : bounds[k] - edge) / pixel;
    assert.ok(beyond > -1e-6 && beyond < 1, `the picture ends ${beyond} pixels beyond the plot`);
  });
  assert.ok(width < 30 && height < 30, "several plants share a pixel");
  const [west, south, east, north] = bounds, best = new Map();
  for (let k = 0; k < places.n; k++) {
    const x = Math.floor(((places.lon[k] - west) / (east - west)) * width), y = Math.floor(((north - places.lat[k]) / (north - south)) * height);
    best.set(y * width + x, Math.max(best.get(y * width + x) ?? -1, ranks[k]));
  }
  let wrong = 0, empty = 0;
  for (let at = 0; at < width * height; at++) {
    const shown = [...data.slice(4 * at, 4 * at + 4)], wanted = best.has(at) ? TABLE[best.get(at)] : [0, 0, 0, 0];
    wrong += !shown.every((v, k) => v === wanted[k]);
    empty += !best.has(at);
  }
  // where a plant stands on the edge of two pixels, either has it
  assert.ok(wrong <= 0.03 * width * height, `${wrong} of ${width * height} pixels are wrong`);
  assert.ok(empty > 20, "the gap is empty");
});

test("a picture of any plot has at most so many pixels", () => {
  const { places, ranks } = gridOf(30, 3000, new Array(90000).fill(0));
  const { image } = pictureOf({ places: { ...places, step: places.step / 5 }, ranks, table: TABLE });
  assert.ok(image.width <= 2049 && image.height <= 2049);
});

test("a picture seen from further away loses no important plant: four pixels become their highest", () => {
  const plants = some(41, 53);
  let level = ranksOf(plants);
  const most = (ranks) => ranks.reduce((a, b) => Math.max(a, b), 0), share = level.top.filter((r) => r === 3).length / level.top.length;
  for (let k = 0; k < 7; k++) {
    const next = halved(level);
    assert.equal(next.step, 2 * level.step);
    assert.ok(next.width * 2 - level.width <= 1 && next.height * 2 - level.height <= 1);
    for (let y = 0; y < level.height; y++) {
      for (let x = 0; x < level.width; x++) assert.ok(next.top[(y >> 1) * next.width + (x >> 1)] >= level.top[y * level.width + x]);
    }
    assert.equal(most(next.top), most(level.top));
    const { bounds } = painted(next, TABLE), before = painted(level, TABLE).bounds;
    assert.deepEqual([bounds[0], bounds[3]], [before[0], before[3]], "its corner stays");
    assert.ok(bounds[2] >= before[2] - 1e-12 && bounds[1] <= before[1] + 1e-12);
    level = next;
  }
  assert.ok(share < 1 && level.width === 1);
});

// 60 x 60 plants, 2.4 m and 2 m apart, on pixels of this many metres
function levelOf(pixel, missing = []) {
  const degree = 111320, lon = [], lat = [];
  for (let r = 0; r < 60; r++) {
    for (let k = 0; k < 60; k++) {
      if (missing.some(([y, x]) => y === r && x === k)) continue;
      lon.push((1 + 2 * k) / degree);
      lat.push((1 + 2.4 * r) / degree);
    }
  }
  const places = { n: lon.length, lon, lat, step: pixel / degree, bounds: [0, 0, 120 / degree, 144 / degree] };
  places.bounds[1] = -72 / degree; // flat: about the equator
  places.bounds[3] = 144 / degree;
  const props = { places, ranks: new Uint8Array(lon.length), apart: 2 };
  return [ranksOf(props), props];
}

function emptyOf({ top, width, height }, rows) {
  let n = 0;
  for (let y = 2; y < rows; y++) for (let x = 2; x < width - 2; x++) if (!top[y * width + x]) n++;
  return n;
}

test("no pixel between plants is empty where pixels are nearly as wide as plants are apart", () => {
  for (const pixel of [1.1, 1.6, 1.9]) {
    const [level, props] = levelOf(pixel), rows = Math.floor(140 / pixel);
    assert.ok(emptyOf(level, rows) > 0, `${pixel}`);
    assert.equal(emptyOf(filled(level, props), rows), 0, `${pixel}`);
  }
});

test("a missing plant stays empty, and none that is there changes its colour", () => {
  const [level, props] = levelOf(1.1, [[30, 30]]), full = filled(level, props);
  assert.ok(emptyOf(full, 120) > 0);
  level.top.forEach((rank, at) => { if (rank) assert.equal(full.top[at], rank); });
});
