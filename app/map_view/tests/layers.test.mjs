// What is drawn on a picture of the ground stands out from any ground, and nothing is asked unseen.

import assert from "node:assert/strict";
import { test } from "node:test";

import { against, casingOf, layersOf, pictureAt } from "../src/layers.js";

const line = { "@@type": "PathLayer", id: "hot-edge", data: [{ p: [[0, 0], [1, 1]] }], getPath: "@@=p", getColor: [20, 26, 30], getWidth: 0.4, widthMinPixels: 3 };
const web = { "@@type": "GroundLayer", id: "ground-map", data: "https://elsewhere/{z}/{x}/{y}.png", minZoom: 0, maxZoom: 19, tileSize: 256 };
const fill = { "@@type": "PathLayer", id: "aisles", data: [], getPath: "@@=p", getColor: [1, 2, 3], getWidth: 1 };
const GROUND = { ids: ["ground-map"], picture: true };
const ids = (layers) => layers.map((one) => one.id);

// WCAG's relative luminance and contrast
function light([r, g, b]) {
  const linear = [r, g, b].map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}
const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);

test("a line and its casing: from any ground, one of the two stands out 3 to 1", () => {
  // hot spots by day and night, outlines, records, plants' rims, what is drawn
  for (const colour of [[20, 26, 30], [255, 255, 255], [60, 70, 60], [190, 200, 190], [0, 190, 255], [255, 220, 90]]) {
    const casing = against(colour);
    for (let grey = 0; grey <= 255; grey++) {
      const ground = [grey, grey, grey];
      assert.ok(Math.max(contrast(colour, ground), contrast(casing, ground)) >= 3, `${colour} on ${grey}`);
    }
  }
  for (let grey = 0; grey <= 255; grey++) {
    for (const [route, casing] of [[[12, 62, 170], [255, 255, 255]], [[110, 220, 255], [10, 20, 26]]]) {
      const most = Math.max(...[route, casing].map((one) => contrast(one, [grey, grey, grey])));
      assert.ok(most >= 3, `the route on ${grey}: ${most}`);
    }
    const rims = [[0, 0, 0], [255, 255, 255]].map((rim) => contrast(rim, [grey, grey, grey]));
    assert.ok(Math.max(...rims) >= 3, `plants' rims on ${grey}`);
  }
});

test("lines and rings get a casing over a picture only, and what has one of its own gets none", () => {
  assert.equal(casingOf(line).widthMinPixels, 6);
  assert.equal(casingOf({ ...line, id: "route" }), null);
  assert.equal(casingOf({ "@@type": "PolygonLayer", id: "hot" }), null);
  assert.deepEqual(ids(layersOf([line], new Set(), 1, { ids: [] })), ["hot-edge"]);
  assert.deepEqual(ids(layersOf([web, line], new Set(), 1, GROUND)), ["ground-map", "hot-edge-casing", "hot-edge"]);
  assert.deepEqual(ids(layersOf([web, line], new Set(), 1, { ...GROUND, picture: false })), ["ground-map", "hot-edge"]);
  const off = layersOf([web, line], new Set(["hot-edge"]), 1, GROUND);
  assert.deepEqual(off.slice(1).map((one) => one.props.visible), [false, false], "a casing goes with its line");
});

test("a map in tiles that is switched off is not there: to draw it is to ask for it", () => {
  assert.deepEqual(ids(layersOf([web, line, fill], new Set(["ground-map"]), 1, GROUND)), ["hot-edge", "aisles"]);
});

test("the plan does not cover the ground, and the ground has its own strength", () => {
  const made = layersOf([web, fill, line], new Set(), 0.3, { ...GROUND, opacity: 0.6 });
  assert.deepEqual(ids(made), ["ground-map", "hot-edge-casing", "hot-edge"]);
  assert.equal(made[0].props.opacity, 0.6);
  let failed = 0;
  const [ground] = layersOf([web], new Set(), 1, { ...GROUND, failed: () => { failed++; } });
  ground.props.onTileError(new Error("away"));
  assert.equal(failed, 1);
});

test("a tile that a map does not have is empty, one that cannot be had is an error", async () => {
  const answers = { a: { status: 204, ok: true }, b: { status: 404, ok: false }, c: { status: 503, ok: false } };
  globalThis.fetch = async (url) => answers[url];
  assert.equal(await pictureAt({ url: "a" }), null);
  assert.equal(await pictureAt({ url: "b" }), null);
  await assert.rejects(pictureAt({ url: "c" }), /503/);
});

test("a map of another server is asked for by its worker, and never by the page", async (context) => {
  const asked = [], begun = [];
  context.mock.method(globalThis, "fetch", () => assert.fail("the page asks no other server"));
  globalThis.createImageBitmap = async (blob) => blob;
  globalThis.Worker = class {
    constructor(address) { begun.push(address); }
    postMessage({ k, url }) {
      asked.push(url ?? `stop ${k}`);
      if (url === "broken") this.onerror();
      else if (url && url !== "slow") this.onmessage({ data: { k, status: url === "none" ? 404 : url === "busy" ? 503 : 200, blob: "picture" } });
    }
  };
  const [ground] = layersOf([web], new Set(), 1, { ...GROUND, worker: "/web_map/x.js" });
  const at = ground.props.getTileData, stop = new AbortController();
  assert.equal(layersOf([web], new Set(), 1, { ...GROUND, worker: "/web_map/x.js" })[0].props.getTileData, at, "no tile is fetched anew");
  assert.equal(await at({ url: "a" }), "picture");
  assert.equal(await at({ url: "none" }), null);
  await assert.rejects(at({ url: "busy" }), /503/);
  at({ url: "slow", signal: stop.signal }).catch(() => {});
  stop.abort();
  assert.deepEqual(asked, ["a", "none", "busy", "slow", "stop 3"]);
  assert.deepEqual(begun, ["/web_map/x.js"]);
  await assert.rejects(at({ url: "broken" }), /broken: 0/);
  assert.equal(await at({ url: "a" }), "picture");
  assert.equal(begun.length, 2, "a worker that failed is begun anew");
});
