// A film holds each picture once, in its colours, as long as it is to be seen.

import assert from "node:assert/strict";
import { test } from "node:test";

import { EACH_MS, gif, kinds, LAST_MS } from "../src/film.js";

// Return the frames' delays in hundredths, and the first frame's palette, of a GIF.
function read(bytes) {
  const delays = [];
  let at = 13 + (bytes[10] & 0x80 ? 3 * 2 ** ((bytes[10] & 7) + 1) : 0), palette = null;
  while (bytes[at] !== 0x3b) {
    if (bytes[at] === 0x21) {
      if (bytes[at + 1] === 0xf9) delays.push(bytes[at + 4] + 256 * bytes[at + 5]);
      at += 2;
    } else {
      assert.equal(bytes[at], 0x2c);
      const own = bytes[at + 9] & 0x80 ? 3 * 2 ** ((bytes[at + 9] & 7) + 1) : 0;
      palette ??= own ? bytes.slice(at + 10, at + 10 + own) : bytes.slice(13);
      at += 11 + own;
    }
    while (bytes[at]) at += bytes[at] + 1;
    at++;
  }
  return { delays, palette, width: bytes[6] + 256 * bytes[7], height: bytes[8] + 256 * bytes[9] };
}

function picture(colour) {
  const data = new Uint8ClampedArray(4 * 6 * 5);
  for (let k = 0; k < 30; k++) data.set([...colour, 255], 4 * k);
  return { width: 6, height: 5, data };
}

test("each picture is a frame; the last one stays longer", async () => {
  const made = read(await gif([picture([250, 0, 0]), picture([0, 250, 0]), picture([0, 0, 250])]));
  assert.deepEqual(made.delays, [EACH_MS, EACH_MS, LAST_MS].map((ms) => Math.round(ms / 10)));
  assert.deepEqual([made.width, made.height], [6, 5]);
  const [red, green, blue] = made.palette;
  assert.ok(red > 240 && green < 16 && blue < 16, "red stays red");
});

test("no pictures are an empty film, and a browser that records nothing still makes a GIF", async () => {
  assert.ok((await gif([])).length < 40);
  assert.deepEqual(kinds(), ["gif"]);
  globalThis.MediaRecorder = Object.assign(function () {}, { isTypeSupported: () => true });
  assert.deepEqual(kinds(), ["gif", "webm"]);
  globalThis.MediaRecorder.isTypeSupported = () => false;
  assert.deepEqual(kinds(), ["gif"], "Safari records, but no WebM");
});
