// How often the map is asked for a frame.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Pace } from "../src/pace.js";

test("a map at rest is looked at four times a second, and drawn at once when it is woken", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const asked = [], told = [], pace = new Pace((rests) => told.push(rests));
  globalThis.requestAnimationFrame = (call) => asked.push(call);
  globalThis.cancelAnimationFrame = () => { asked.length = 0; };
  // as deck.gl does: each frame asks for the next
  let frames = 0;
  const draw = () => { frames++; pace.requestAnimationFrame(draw); };
  const drawn = () => { while (asked.length) asked.shift()(0); return frames; };
  pace.requestAnimationFrame(draw);
  const first = drawn();
  assert.deepEqual(told, [true]);
  t.mock.timers.tick(1000);
  assert.equal(drawn(), first + 1, "an image that came is seen");
  t.mock.timers.tick(200);
  assert.equal(drawn(), first + 1);
  pace.wake();
  assert.equal(drawn(), first + 11, "whatever moves has all frames");
  assert.deepEqual(told, [true, false, true]);
  pace.cancelAnimationFrame();
  t.mock.timers.tick(1000);
  assert.equal(drawn(), first + 11, "a map that has gone is not drawn");
});
