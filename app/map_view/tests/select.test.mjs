// Rows are selected and given back whole; what is told of a selection is all of it.

import assert from "node:assert/strict";
import { test } from "node:test";

import { ofRuns, rowsOf, runsOf, withRow } from "../src/select.js";
import { random } from "./plots.mjs";

// three rows; a hole cuts the second in two pieces that are not numbered one after the other
const places = { n: 9, row: Int32Array.from([1, 1, 1, 2, 2, 3, 3, 2, 2]) };

test("a row is all plants of its number, however many pieces it has", () => {
  assert.deepEqual(rowsOf(places).get(2), [3, 4, 7, 8]);
  assert.deepEqual([...withRow(places, new Set(), 2)], [3, 4, 7, 8]);
});

test("a row tapped twice is given back, a row half selected is completed", () => {
  const once = withRow(places, new Set([0]), 2);
  assert.deepEqual([...withRow(places, once, 2)], [0]);
  assert.deepEqual([...withRow(places, new Set([3, 5]), 2)].sort(), [3, 4, 5, 7, 8]);
  assert.deepEqual([...withRow(places, new Set([1]), 99)], [1], "there is no such row");
});

test("runs hold the very plants, each once, and are few for whole rows", () => {
  const next = random(7);
  for (let k = 0; k < 50; k++) {
    const some = new Set(Array.from({ length: Math.floor(next() * 60) }, () => Math.floor(next() * 80)));
    const runs = runsOf(some);
    assert.deepEqual([...ofRuns(runs)], [...some].sort((a, b) => a - b));
    runs.forEach(([first], j) => assert.ok(j === 0 || first > runs[j - 1][1] + 1, "runs that touch are one"));
  }
  assert.deepEqual(runsOf(rowsOf(places).get(1)), [[0, 2]]);
});
