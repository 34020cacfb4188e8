// A message does not lie over the boxes for longer than it is needed.

import assert from "node:assert/strict";
import { test } from "node:test";

import { letNoticesGo } from "../src/notice.js";

test("a message lies over the panel until something is pressed there that asks nothing", () => {
  let press = null;
  const inside = {}, notice = { parentElement: { style: { position: "" } }, contains: (one) => one === inside };
  globalThis.document = { addEventListener: (_, on) => { press = on; }, querySelector: () => notice };
  letNoticesGo();
  const at = (...found) => {
    press({ target: { closest: (wanted) => found.some((one) => wanted.startsWith(one)) || null } });
    return notice.parentElement.style.position;
  };
  press({ target: inside });
  assert.equal(notice.parentElement.style.position, "");
  assert.equal(at(), "", "the map is not under it");
  assert.equal(at(".st-key-panel"), "static");
  assert.equal(at(".st-key-panel", "button"), "", "what that says comes over it again");
});
