import assert from "node:assert/strict";
import { before, mock, test } from "node:test";
import { Runner } from "../src/runner.js";
import { call, Held, NotNow } from "../src/sync.js";

const turns = async () => { for (let k = 0; k < 20; k++) await Promise.resolve(); };

before(() => {
  globalThis.addEventListener ??= () => {};
  globalThis.document = { addEventListener() {}, hidden: false };
  Object.defineProperty(globalThis, "navigator", { value: {}, configurable: true });
});

test("what is tapped while something is sent goes a second later, not a minute", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout", "Date"] });
  let sent = 0, free;
  const sync = { send: mock.fn(() => { sent += 1; return new Promise((done) => { free = done; }); }), stranded: new Map() };
  const field = { reread: async () => {}, refresh: async () => {}, day: {} };
  const runner = new Runner(sync, field, () => {});
  runner.now();
  t.mock.timers.tick(0);
  await turns();
  assert.equal(sent, 1);
  runner.afterTap(); // the first is on its way still
  free();
  await turns();
  t.mock.timers.tick(1000);
  await turns();
  assert.equal(sent, 2);
});

test("news is asked for each minute, though the clock is set back by an hour", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  let wall = 1e12, asked = 0;
  t.mock.method(Date, "now", () => wall);
  const field = { reread: async () => {}, refresh: async () => { asked += 1; }, day: {} };
  new Runner({ send: async () => {}, stranded: new Map() }, field, () => {}).now();
  for (const [passed, times] of [[0, 1], [60000, 2], [60000 - 3600000, 3], [60000, 4]]) {
    wall += passed;
    t.mock.timers.tick(times === 1 ? 0 : 60000);
    await turns();
    assert.equal(asked, times);
  }
});

test("what was found or taken back here is asked for as soon as it is sent, not a minute later", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout", "Date"], now: 1e12 });
  let asked = 0;
  const field = { reread: async () => {}, refresh: async () => { asked += 1; }, day: {}, changedHere: () => false };
  const runner = new Runner({ send: async () => {}, stranded: new Map() }, field, () => {});
  for (const [changed, times] of [[false, 1], [false, 1], [true, 2]]) {
    field.changedHere = () => changed;
    runner.afterTap();
    t.mock.timers.tick(1000);
    await turns();
    assert.equal(asked, times);
  }
});

test("a network that is lost is tried again by and by, and at once after a tap", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout", "Date"] });
  let sent = 0;
  const sync = { send: async () => { sent += 1; throw new Error("no network"); }, stranded: new Map() };
  const runner = new Runner(sync, { reread: async () => {}, refresh: async () => {}, day: {} }, () => {});
  runner.now();
  for (const [ms, times] of [[0, 1], [3000, 2], [3000, 2], [3000, 3]]) {
    t.mock.timers.tick(ms);
    await turns();
    assert.equal(sent, times);
  }
  runner.afterTap();
  t.mock.timers.tick(1000);
  await turns();
  assert.equal(sent, 4);
});

test("a season that another program holds is called so, and any other failure a missing network", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout", "Date"] });
  for (const [body, state, kind] of [['{"error": "held", "cause": "held"}', "held", Held], ['{"error": "away"}', "offline", NotNow], ["<html>", "offline", NotNow]]) {
    const ask = async () => new Response(body, { status: 503 });
    await assert.rejects(call(ask, { season: "Gate", key: "k" }, "day"), (error) => error.constructor === kind);
    const said = [], error = await call(ask, { season: "Gate", key: "k" }, "day").catch((one) => one);
    new Runner({ send: async () => { throw error; }, stranded: new Map() }, { reread: async () => {}, refresh: async () => {}, day: {} }, (one) => said.push(one)).now();
    t.mock.timers.tick(0);
    await turns();
    assert.equal(said.at(-1), state);
  }
});
