import assert from "node:assert/strict";
import { test } from "node:test";
import { afterFind, results, secondsAhead, secondsLeft } from "../src/plan.js";
import { laidOut } from "../src/geo.js";
import { aDay, facedPlot, laid } from "./scene.mjs";

const plot = laid(), day = aDay();

test("after a find its neighbours come next, then the route as it was", () => {
  assert.deepEqual(afterFind(plot, day, [1, 2, 10, 11], 0, new Set([0]), 1e5), [1, 5, 2, 10, 11]);
});

test("after a find the other face comes last of its neighbours: the way to it goes round the row's end", () => {
  assert.deepEqual(afterFind(laidOut(facedPlot(), "p2"), day, [10], 2, new Set([2]), 1e5), [1, 3, 7, 10]);
});

test("what was inspected is not inspected again", () => {
  assert.deepEqual(afterFind(plot, day, [2], 0, new Set([0, 1, 5]), 1e5), [2]);
});

test("what does not fit the hours is left out at the end, and neighbours only come if hours allow", () => {
  const all = afterFind(plot, day, [1, 2, 10, 11], 0, new Set([0]), 1e5);
  for (const left of [0, 30, 40, 80, 120, 200, 300]) {
    const ahead = afterFind(plot, day, [1, 2, 10, 11], 0, new Set([0]), left);
    assert.deepEqual(ahead, all.slice(0, ahead.length), `${left}`);
    assert.ok(secondsAhead(plot, day, 0, ahead) <= left, `${left}: ${ahead}`);
  }
  assert.deepEqual(afterFind(plot, day, [1, 2], 0, new Set([0]), 0), []);
});

test("after a find the hours do for the way back, too: as the server said it, to where its line ends, or to the gate", () => {
  const route = { plants: [1, 2, 3, 4], walk_s: [2, 2, 2, 2], end_s: 4 * 37 + 30, line: [[35, 30], [34.9997, 30]] };
  const at = { ...plot, gate: [plot.x[0] - 28.95, plot.y[0]] }, done = new Set([0, 1, 6]); // 0.0003 degrees of longitude
  const withLine = aDay([], { route }), withGate = aDay([], { route: { ...route, line: [] } });
  const stays = aDay([], { route, robot: { ...withLine.robot, returns: false } });
  for (const [one, day] of [[plot, withLine], [at, withGate]]) {
    const fits = (left) => afterFind(one, day, [2, 3, 4], 1, done, left);
    assert.deepEqual([fits(140), fits(141)], [[2, 3], [2, 3, 4]]);
    assert.deepEqual([fits(108), fits(110)], [[2], [2, 3]]);
    assert.ok(Math.abs(secondsAhead(one, day, 1, [2, 3]) - (2 * 37 + 35)) < 0.5);
    assert.deepEqual([fits(69), fits(71)], [[], [2]]);
  }
  assert.deepEqual(afterFind(plot, stays, [2, 3, 4], 1, done, 111), [2, 3, 4]);
  assert.deepEqual(afterFind(plot, withLine, [], 1, new Set([0, 1]), 40), [], "neighbours neither");
});

test("legs take what the server said; others are reckoned", () => {
  assert.equal(secondsAhead(plot, day, -1, [0, 1, 2]), 3 * 37);
  assert.ok(Math.abs(secondsAhead(plot, day, 0, [4]) - (8 + 35)) < 0.2);
});

test("the hours run from the first record", () => {
  assert.equal(secondsLeft(day, null, 5e6), 14400);
  assert.equal(secondsLeft(day, 1e6, 1e6 + 60000), 14340);
  assert.equal(secondsLeft(day, 1e6, 1e12), 0);
});

test("what was taken back does not count", () => {
  const records = [{ id: "a", plant: 1, result: "clean" }, { id: "b", plant: 2, result: "found" }, { id: "c", undoes: "a" }];
  assert.deepEqual([...results(records)].map(([plant, one]) => [plant, one.result]), [[2, "found"]]);
});
