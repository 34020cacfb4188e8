// One step back for each thing that a person does.

import assert from "node:assert/strict";
import { test } from "node:test";

import { keepOneStep } from "../src/address.js";

test("what the page adds to the address is no step of its own", () => {
  const heard = {}, steps = ["/"];
  const hear = (kind, on) => { heard[kind] = on; };
  globalThis.document = { addEventListener: hear };
  globalThis.window = { addEventListener: hear };
  globalThis.history = {
    pushState: (_, __, to) => steps.push(to), replaceState: (_, __, to) => { steps[steps.length - 1] = to; },
  };
  keepOneStep();
  const push = (to) => globalThis.history.pushState({}, "", to);
  push("/?season=A");
  assert.deepEqual(steps, ["/?season=A"], "nobody did anything yet");
  heard.pointerdown();
  for (const to of ["/", "/season", "/season?season=A", "/season?season=A&day=1"]) push(to);
  assert.deepEqual(steps, ["/?season=A", "/season?season=A&day=1"]);
  heard.keydown();
  push("/season?season=A&part=report");
  assert.equal(steps.length, 3);
  heard.keydown(); // Alt and the arrow
  steps.pop();
  heard.popstate();
  push("/season?season=A&day=1");
  assert.deepEqual(steps, ["/?season=A", "/season?season=A&day=1"]);
});
