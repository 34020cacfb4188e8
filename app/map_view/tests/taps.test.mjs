// Two taps on a plant are one; the next one counts as soon as another plant is shown.

import assert from "node:assert/strict";
import { test } from "node:test";

import { oneTapEach } from "../src/taps.js";

test("a second tap counts once the page shows another plant, or if the first was lost", (context) => {
  let now = 1000, shown = 0, hear;
  context.mock.method(performance, "now", () => now);
  globalThis.document = { addEventListener: (_, act) => { hear = act; },
    querySelectorAll: () => [{ className: `other st-key-scout_after_${shown} more` }] };
  oneTapEach();
  const button = (isScouts) => ({ closest: (what) => (what === "button" ? button(isScouts) : isScouts) });
  const taps = (isScouts = true) => {
    let counts = true;
    hear({ target: button(isScouts), preventDefault() {}, stopImmediatePropagation() { counts = false; } });
    return counts;
  };
  assert.equal(taps(), true);
  now += 250;
  assert.equal(taps(), false, "the plant of the first is still shown");
  assert.equal(taps(false), true, "no button of Scout");
  shown = 1;
  assert.equal(taps(), true, "at once, however fast");
  assert.equal(taps(), false);
  now += 10_000;
  assert.equal(taps(), true, "nothing came of the one before");
});
