// A day is played along its line, in its own time.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Playback } from "../src/playback.js";

const PLAN = {
  line: [[0, 0], [1, 0], [1, 2], [0, 2]], at_s: [0, 100, 300, 400], stops: [[1, 0.1], [1, 1.9]], leave_s: [140, 350],
  starts_s: 6 * 3600 + 30 * 60, key: "a",
};

function playing(second) {
  // the page's own parts are not needed for what is drawn
  return Object.assign(Object.create(Playback.prototype), { plan: PLAN, second });
}

const layerOf = (playback, id) => playback.layers(false).find((one) => one.id === id).data;

test("who drives is where the line is at that second, and the trail ends there", () => {
  for (const [second, here] of [[0, [0, 0]], [50, [0.5, 0]], [100, [1, 0]], [200, [1, 1]], [400, [0, 2]], [9999, [0, 2]]]) {
    const now = playing(second);
    assert.deepEqual(layerOf(now, "robot")[0].q, here);
    assert.deepEqual(layerOf(now, "trail")[0].q.at(-1), here);
    assert.deepEqual(layerOf(now, "trail")[0].q[0], [0, 0]);
  }
});

test("stops are made once they are left", () => {
  const made = [0, 139, 140, 349, 350, 400].map((second) => layerOf(playing(second), "stops-made").length);
  assert.deepEqual(made, [0, 0, 1, 1, 2, 2]);
});

test("the trail grows as the day goes on", () => {
  const lengths = [10, 150, 350].map((second) => layerOf(playing(second), "trail")[0].q.length);
  assert.deepEqual(lengths, [2, 3, 4]);
});

test("nothing is drawn before anything was played", () => {
  assert.deepEqual(playing(null).layers(false), []);
});

test("the clock says the time of the day, past midnight too", () => {
  const clock = { textContent: "" };
  const at = (starts_s, second) => {
    Object.assign(playing(0), { plan: { ...PLAN, starts_s }, clock }).tell(second);
    return clock.textContent;
  };
  assert.equal(at(PLAN.starts_s, 0), "06:30");
  assert.equal(at(PLAN.starts_s, 3599), "07:29");
  assert.equal(at(23 * 3600, 2 * 3600), "01:00");
});

test("a day that is played begins at its beginning though its first frame is older than the click, and goes on", () => {
  const frames = [], seen = [];
  globalThis.requestAnimationFrame = (step) => frames.push(step);
  globalThis.cancelAnimationFrame = () => {};
  const day = Object.assign(playing(null), { press: {}, slider: {}, clock: {} });
  day.changed = () => seen.push(layerOf(day, "robot")[0].q);
  day.toggle();
  const click = performance.now();
  for (const now of [click - 40, click - 24, click + 5000, click + 40000]) frames.shift()(now);
  assert.deepEqual(seen[0], [0, 0]);
  assert.deepEqual(seen.at(-1), [0, 2]);
  assert.equal(frames.length, 0);
});
