import assert from "node:assert/strict";
import { test } from "node:test";
import { laidOut } from "../src/geo.js";
import { withAsked } from "../src/plan.js";
import { around, wayAhead } from "../src/way.js";
import { aDay, aPlot, laid } from "./scene.mjs";

const plot = laid(), near = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) < 0.01;

/** Whether a line passes between two plants that stand next to each other in a row. */
function crossesARow(plot, line) {
  const side = (p, q, r) => Math.sign((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
  const at = (i) => [plot.x[i], plot.y[i]];
  for (let k = 0; k < plot.row.length; k++) for (let i = plot.start[k]; i + 1 < plot.start[k + 1]; i++) {
    const [p, q] = [at(i), at(i + 1)];
    for (let j = 0; j + 1 < line.length; j++) {
      const [a, b] = [line[j], line[j + 1]];
      if (side(p, q, a) * side(p, q, b) < 0 && side(a, b, p) * side(a, b, q) < 0) return true;
    }
  }
  return false;
}

/** Rows of `lengths` plants, two and two at one aisle, or each at its own; they begin at one line, or end there. */
function plotOf(lengths, endsMeet = false, own = false) {
  const lon = [], lat = [], number = [], start = [0], most = Math.max(...lengths);
  lengths.forEach((n, row) => {
    for (let k = 0; k < n; k++) {
      lon.push(35 + (2 * (k + (endsMeet ? most - n : 0))) / 96000); lat.push(30 + (3 * row) / 110900); number.push(k + 1);
    }
    start.push(lon.length);
  });
  return laidOut({ ...aPlot(), rows: { start, row: lengths.map((_, k) => k + 1), aisle: lengths.map((_, k) => (own ? k : k >> 1)),
    side: lengths.map((_, k) => (k % 2 && !own ? -1 : 1)) },
    plants: { lon, lat, number } }, "p");
}

test("a way between any two plants begins and ends beside them and goes through no row", () => {
  for (const one of [plot, plotOf([5, 9, 3, 12, 4, 6]), plotOf([5, 9, 3, 12, 4, 6], true), plotOf([5, 9, 3, 12, 4, 6], false, true), plotOf([1, 4, 1, 4, 1])]) {
    const n = one.x.length;
    for (let a = 0; a < n; a++) for (let b = 0; b < n; b++) {
      const line = around(one, a, b), beside = ([x, y], i) => Math.hypot(x - one.x[i], y - one.y[i]);
      assert.ok(Math.abs(beside(line[0], a) - 1.5) < 0.01 && Math.abs(beside(line.at(-1), b) - 1.5) < 0.01);
      assert.ok(!crossesARow(one, line), `${a} to ${b}`);
    }
  }
});

test("a way is the same whatever its rows are called", () => {
  const one = plotOf([5, 9, 3, 12, 4, 6]), named = { ...one, row: Int32Array.from([5, 6, 1, 2, 3, 9]) };
  for (let a = 0; a < one.x.length; a++) assert.deepEqual(around(named, 0, a), around(one, 0, a));
});

test("rows that share an aisle are both reached from it", () => {
  const line = around(plot, 0, 9);
  assert.ok(line.every(([, y]) => Math.abs(y - (plot.y[0] + plot.y[5]) / 2) < 0.01), "it stays in the middle of the aisle");
});

test("the line ahead is the server's where it goes the same legs, and its own after a find", () => {
  const lane = 30.00001, line = [[34.99998, 29.9999], [34.99998, lane], [35, lane], [35.00002, lane], [35.00004, lane], [34.99998, lane], [34.99998, 29.9999]];
  const route = { plants: [0, 1, 2], walk_s: [2, 2, 2], end_s: 200, line, stops: [2, 3, 4] }, day = aDay([], { route });
  const at = line.map(([lon, lat]) => [(lon - plot.lon0) * plot.kx, (lat - plot.lat0) * plot.ky]);
  assert.ok(wayAhead(plot, day, -1, [0, 1, 2]).every((one) => at.some((other) => near(one, other))));
  assert.ok(near(wayAhead(plot, day, 0, [1, 2])[0], at[2]), "from where one stands");
  assert.ok(near(wayAhead(plot, day, 0, [1, 2]).at(-1), at[6]), "and back to the gate");
  const after = wayAhead(plot, day, 0, [1, 11, 2]);
  assert.ok(!crossesARow(plot, after));
  assert.ok(near(after.at(-1), at[6]));
  assert.deepEqual(wayAhead(plot, day, 2, []), []);
});

test("a plant with a photo asked for comes where it is the least way round, and others make room", () => {
  const day = aDay([0, 1, 4], { route: { plants: [0, 1, 4], walk_s: [0, 2, 6], end_s: 113, line: [] } });
  assert.deepEqual(withAsked(plot, day, -1, [0, 1, 4], [3], 1e5), [0, 1, 3, 4]);
  assert.deepEqual(withAsked(plot, day, 0, [1, 4], [3, 1], 1e5), [1, 3, 4]);
  assert.deepEqual(withAsked(plot, day, 0, [1, 4], [3], 80), [1, 3]);
  assert.deepEqual(withAsked(plot, day, 0, [1, 4], [3], 0), [1, 3], "it takes no more room than it needs");
  assert.deepEqual(withAsked(plot, day, 0, [4], [3], 0), [3], "what is asked for is not left out");
  assert.deepEqual(withAsked(plot, day, 0, [1, 4], [], 0), [1, 4], "and without it nothing changes");
});
