// A day that was typed counts at once.

import assert from "node:assert/strict";
import { test } from "node:test";

import { takeDays } from "../src/days.js";

test("a day counts by Enter, and by Tab from its last part alone", () => {
  let hear = null;
  globalThis.document = { addEventListener: (_, on) => { hear = on; } };
  globalThis.KeyboardEvent = class { constructor(kind, given) { Object.assign(this, given); } };
  takeDays();
  const box = { querySelectorAll: () => parts };
  const part = (matches = true, of = box) => ({
    sent: [], closest: () => of, matches: () => matches, dispatchEvent({ key }) { this.sent.push(key); },
  });
  const parts = [part(), part()], [year, day] = parts;
  const pressed = (target, key, shiftKey = false) => { target.sent = []; hear({ key, shiftKey, target }); return target.sent; };
  assert.deepEqual(pressed(year, "Enter"), ["Escape"]);
  assert.deepEqual(pressed(day, "Enter"), ["Escape"]);
  assert.deepEqual(pressed(day, "Tab"), ["Escape"]);
  assert.deepEqual(pressed(year, "Tab"), [], "the next part is to be typed");
  assert.deepEqual(pressed(day, "Tab", true), []);
  assert.deepEqual(pressed(day, "2"), []);
  assert.deepEqual(pressed(day, "Escape"), [], "its own press is none of ours");
  assert.deepEqual(pressed(part(false), "Enter"), [], "the button of the calendar");
  assert.deepEqual(pressed(part(true, null), "Enter"), [], "a box of a number");
});
