// What lies under the pointer is what brute force says lies there.

import assert from "node:assert/strict";
import { test } from "node:test";

import { nearestPlant, plantsWithin, rowsUnder, within, tipOf } from "../src/pick.js";
import { random, scattered } from "./plots.mjs";

const METRES = 111320;

function byBruteForce({ n, lon, lat }, [x, y], reachM) {
  const flat = Math.cos((y * Math.PI) / 180);
  let best = -1, least = reachM;
  for (let k = 0; k < n; k++) {
    const far = Math.hypot((lon[k] - x) * flat, lat[k] - y) * METRES;
    if (far <= least) { least = far; best = k; }
  }
  return [best, least];
}

for (const lat of [-41, 0, 30.3, 59]) {
  test(`the nearest plant is found at ${lat} degrees, and none beyond the reach`, () => {
    const places = scattered(4000, 35.1, lat), next = random(7);
    const [west, south, east, north] = places.bounds;
    let found = 0;
    for (let k = 0; k < 600; k++) {
      const here = [west + (1.4 * next() - 0.2) * (east - west), south + (1.4 * next() - 0.2) * (north - south)];
      const reachM = 0.5 + 12 * next();
      const mine = nearestPlant(places, here, reachM), [best, least] = byBruteForce(places, here, reachM);
      if (mine !== best) {
        // two plants as far as each other, or one at the very reach: only that may differ
        const other = mine < 0 ? reachM : byBruteForce({ n: 1, lon: [places.lon[mine]], lat: [places.lat[mine]] }, here, 1e9)[1];
        assert.ok(Math.abs(other - least) < 1e-3 * reachM, `${mine} is ${other} m off, ${best} ${least} m`);
      }
      found += mine >= 0;
    }
    assert.ok(found > 100 && found < 600);
  });
}

test("a single plant and a row of plants have an index too", () => {
  for (const n of [1, 2, 9]) {
    const lon = Float64Array.from({ length: n }, (_, k) => 35 + k * 3e-5), lat = new Float64Array(n).fill(30);
    const places = { n, lon, lat, step: 3e-5, bounds: [35 - 2e-5, 30 - 2e-5, 35 + n * 3e-5, 30 + 2e-5] };
    for (let k = 0; k < n; k++) assert.equal(nearestPlant(places, [lon[k] + 1e-6, 30], 1), k);
    assert.equal(nearestPlant(places, [34, 30], 5), -1);
  }
});

test("plants within a ring are those that the even-odd rule says, of any shape", () => {
  const places = scattered(2000, 35.1, 30.3), [west, south, east, north] = places.bounds;
  const at = (x, y) => [west + x * (east - west), south + y * (north - south)];
  const box = [at(0.2, 0.3), at(0.7, 0.3), at(0.7, 0.9), at(0.2, 0.9)];
  const inBox = plantsWithin(places, box);
  const wanted = [];
  for (let k = 0; k < places.n; k++) {
    const [x, y] = [places.lon[k], places.lat[k]];
    if (x > box[0][0] && x < box[1][0] && y > box[0][1] && y < box[2][1]) wanted.push(k);
  }
  assert.deepEqual(inBox, wanted);
  assert.deepEqual(plantsWithin(places, [...box].reverse()), wanted);
  // the notch of an L is outside
  const l = [at(0, 0), at(1, 0), at(1, 0.5), at(0.5, 0.5), at(0.5, 1), at(0, 1)];
  assert.ok(within(at(0.25, 0.75), l) && within(at(0.75, 0.25), l) && !within(at(0.75, 0.75), l));
  assert.deepEqual(plantsWithin(places, []), []);
});

test("of what lies on each other, the last drawn is under the pointer; areas hold, points reach", () => {
  const area = [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]];
  const rows = [{ p: area, t: "area" }, { p: [5e-4, 5e-4], t: "point" }, { p: area }, { p: null, t: "nowhere" }];
  assert.deepEqual(rowsUnder(rows, [5e-4, 5e-4], 3), [1, 0]);
  assert.deepEqual(rowsUnder(rows, [2e-4, 2e-4], 3), [0]);
  assert.deepEqual(rowsUnder(rows, [5e-4 + 2.9 / METRES, 5e-4], 3), [1, 0]);
  assert.deepEqual(rowsUnder(rows, [5e-4 + 3.1 / METRES, 5e-4], 3), [0]);
  assert.deepEqual(rowsUnder(rows, [2e-3, 2e-3], 3), [], "what says nothing is not pointed at");
});

test("an area with a hole is under the pointer, but not in its hole", () => {
  const square = (low, high) => [[low, low], [high, low], [high, high], [low, high], [low, low]];
  const rows = [{ p: [square(0, 1e-3), square(4e-4, 6e-4)], t: "with a pond" }];
  assert.deepEqual(rowsUnder(rows, [2e-4, 2e-4], 3), [0]);
  assert.deepEqual(rowsUnder(rows, [5e-4, 5e-4], 3), []);
});

test("what is said of a plant is where it stands, what is believed, and what is known of it", () => {
  const places = { row: [3, 3], number: [7, 8] }, tips = { text: "row {row}, plant {plant}{note}" };
  const chances = { places, ranks: [0, 1], values: [0.5, 0.021], notes: [1, 0], tips: { ...tips, values: ": {chance} chance", notes: ["never inspected", "clean today"] } };
  assert.equal(tipOf(chances, 1), "row 3, plant 8: 2.1 % chance\nnever inspected");
  assert.equal(tipOf(chances, 0), "row 3, plant 7: 50.0 % chance\nclean today");
  assert.equal(tipOf({ places, ranks: [0, 1], tips: { ...tips, ranks: ["", ": found"] } }, 1), "row 3, plant 8: found");
  assert.equal(tipOf({ places, ranks: [0, 1], tips }, 0), "row 3, plant 7");
  assert.equal(tipOf({ places, ranks: [0, 1], tips: { ...tips, rows: { 3: "3 · Top" } } }, 0), "row 3 · Top, plant 7");
  const faced = { places: { ...places, face: [2, 0] }, ranks: [0, 1], tips: { ...tips, faces: "{number}, face {face}" } };
  assert.deepEqual([tipOf(faced, 0), tipOf(faced, 1)], ["row 3, plant 7, face 2", "row 3, plant 8"]);
});

test("a chance is said with what it would be at both ends of the plot's level, on its odds", () => {
  const places = { row: [3, 3, 3], number: [7, 8, 9] };
  const tips = { text: "row {row}, plant {plant}{note}", values: ": {chance} chance", between: ": {chance} chance ({low} to {high})", odds: [0.5, 2], least: "next to none", most: "all but all" };
  const json = { places, values: [0.12, 0.5, 1e-6], tips };
  // 0.12 : 0.88 is 0.06 : 0.88 at the low end, 0.24 : 0.88 at the high one
  assert.equal(tipOf(json, 0), "row 3, plant 7: 12.0 % chance (6.4 to 21.4 %)");
  assert.equal(tipOf(json, 1), "row 3, plant 8: 50.0 % chance (33.3 to 66.7 %)");
  assert.equal(tipOf(json, 2), "row 3, plant 9: next to none chance", "no interval of nothing");
  assert.equal(tipOf({ places, values: [0.99999], tips }, 0), "row 3, plant 7: all but all chance");
});

test("no end of an interval is said to be nothing or all, and numbers are written as the language does", () => {
  const places = { row: [3, 3, 3], number: [7, 8, 9] };
  const tips = { text: "{note}", values: "{chance}", between: "{chance} ({low} to {high})", odds: [0.5, 2], least: "next to none", most: "all but all" };
  const json = { places, values: [0.0006, 0.9993, 0.12], tips };
  assert.equal(tipOf(json, 0), "0.1 % (next to none to 0.1 %)");
  assert.equal(tipOf(json, 1), "99.9 % (99.9 % to all but all)");
  assert.equal(tipOf({ ...json, tips: { ...tips, half: "50,0 %" } }, 2), "12,0 % (6,4 to 21,4 %)");
  assert.equal(tipOf({ ...json, tips: { ...tips, half: "50.0%" } }, 2), "12.0% (6.4 to 21.4%)");
});
