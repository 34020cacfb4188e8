// Pictures one after the other as a file: WebM as the browser records it, or GIF.

import * as gifenc from "gifenc";

// bundled it is a module, in Node it is not
const { applyPalette, GIFEncoder, quantize } = gifenc.GIFEncoder ? gifenc : gifenc.default;

export const EACH_MS = 700, LAST_MS = 2000;
const WEBM = "video/webm";

// Return the kinds of film that this browser can make.
export function kinds() {
  const records = typeof MediaRecorder === "function" && MediaRecorder.isTypeSupported(WEBM);
  return records ? ["gif", "webm"] : ["gif"];
}

// Return a GIF of pictures {width, height, data (RGBA)}, which come one by one; it plays for ever.
export async function gif(pictures) {
  const made = GIFEncoder();
  let before = null;
  for await (const picture of pictures) {
    if (before) add(made, before, EACH_MS);
    before = picture;
  }
  if (before) add(made, before, LAST_MS);
  made.finish();
  return made.bytes();
}

function add(made, { width, height, data }, delay) {
  const palette = quantize(data, 256, { format: "rgb565" });
  made.writeFrame(applyPalette(data, palette, "rgb565"), width, height, { palette, delay });
}

// Return a WebM of canvases, which come one by one.
export async function webm(canvases) {
  let shown = null, recorder = null;
  const parts = [], wait = (ms) => new Promise((done) => setTimeout(done, ms));
  for await (const canvas of canvases) {
    if (!shown) {
      shown = document.createElement("canvas");
      Object.assign(shown, { width: canvas.width, height: canvas.height });
      shown.getContext("2d").drawImage(canvas, 0, 0);
      recorder = new MediaRecorder(shown.captureStream(25), { mimeType: WEBM, videoBitsPerSecond: 6e6 });
      recorder.ondataavailable = ({ data }) => parts.push(data);
      recorder.start();
    }
    shown.getContext("2d").drawImage(canvas, 0, 0);
    await wait(EACH_MS);
  }
  if (!recorder) return null;
  await wait(LAST_MS - EACH_MS);
  const ended = new Promise((done) => { recorder.onstop = done; });
  recorder.stop();
  await ended;
  return new Blob(parts, { type: WEBM });
}
