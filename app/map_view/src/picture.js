// The map as a picture of its own, for a report: what the panel leaves free, with what lies on it.

import { NORTH } from "./chrome.js";

const PAD = 12, LINE = 18, TITLE_PX = 20, FONT = "system-ui, sans-serif";
// on what is narrower the legend would lie over the plot
const NARROW_PX = 600;

// Return the part of the map that is taken: what panels leave free, in CSS pixels.
export function freePart({ width, height }, { left, right, bottom }) {
  return { x: left, y: 0, width: Math.max(50, width - left - right), height: Math.max(50, height - bottom) };
}

// Draw the map with its words, legend and scale.
//
// `shot` is {canvas, size, part, colours: {ground, surface, ink, route}, title, credit, legend: [{title, scale, items}],
// signs (sign and colour to image), labels: [{x, y, t, k}], bar: {px, text, bearing}, rtl, most, onPicture}; returns a canvas.
export function composed(shot) {
  const { canvas, size, part, colours } = shot;
  const ratio = Math.min(canvas.width / size.width, (shot.most ?? 4000) / part.width);
  const made = document.createElement("canvas");
  made.width = Math.round(part.width * ratio);
  const pen = made.getContext("2d"), lines = linesOf(shot.legend ?? []), wide = lineWidth(pen, lines);
  const place = legendPlace(part, lines.length, wide), high = part.height + place.below;
  made.height = Math.round(high * ratio);
  pen.scale(ratio, ratio);
  pen.fillStyle = colours.ground;
  pen.fillRect(0, 0, part.width, high);
  const own = canvas.width / size.width;
  pen.drawImage(canvas, part.x * own, part.y * own, part.width * own, part.height * own, 0, 0, part.width, part.height);
  pen.textBaseline = "middle";
  for (const label of shot.labels ?? []) {
    word(pen, { ...label, x: label.x - part.x, y: label.y - part.y }, colours, shot.onPicture);
  }
  if (shot.title) title(pen, shot, part);
  legend(pen, shot, { width: part.width, height: high }, { ...place, wide });
  foot(pen, shot, part);
  return made;
}

function box(pen, x, y, width, height, colour) {
  pen.fillStyle = colour;
  pen.beginPath();
  pen.roundRect(x, y, width, height, 8);
  pen.fill();
}

function word(pen, { x, y, t, k }, { surface, ink, route, onRoute }, onPicture) {
  pen.font = `600 12px ${FONT}`;
  pen.textAlign = "center";
  const lines = t.split("\n"), wide = Math.max(...lines.map((one) => pen.measureText(one).width)) + 10, tall = 18 * lines.length;
  if (k !== "plots" && (onPicture || !["row", "place", "gate", "block"].includes(k))) box(pen, x - wide / 2, y - tall / 2, wide, tall, { leg: route, hot: ink }[k] ?? surface);
  pen.fillStyle = { leg: onRoute, hot: surface, plots: "#fff" }[k] ?? ink;
  lines.forEach((one, n) => pen.fillText(one, x, y + (n - (lines.length - 1) / 2) * 18));
}

function title(pen, { title: said, colours, rtl }, part) {
  pen.font = `600 ${TITLE_PX}px ${FONT}`;
  pen.direction = rtl ? "rtl" : "ltr";
  pen.font = `600 ${titleSize(pen.measureText(said).width, part.width)}px ${FONT}`;
  const wide = pen.measureText(said).width + 2 * PAD, x = rtl ? part.width - PAD - wide : PAD;
  box(pen, x, PAD, wide, 36, colours.surface);
  pen.fillStyle = colours.ink;
  pen.textAlign = "center";
  pen.fillText(said, x + wide / 2, PAD + 19);
}

// Return the size of letters in which a title has room that is so wide in the usual one.
export function titleSize(wide, room) {
  return Math.max(6, Math.min(TITLE_PX, Math.floor(10 * TITLE_PX * (room - 4 * PAD) / wide) / 10));
}

// Return the lines of a legend: a sign and its words each; a scale is one line a class.
export function linesOf(parts) {
  return parts.flatMap(({ title: said, items }) => [
    ...(said ? [{ title: said }] : []),
    ...items.map(([sign, colour, text]) => ({ sign, colour, text })),
  ]);
}

function lineWidth(pen, lines) {
  pen.font = `12px ${FONT}`;
  return Math.max(0, ...lines.map((line) => pen.measureText(line.title ?? line.text).width + (line.title ? 8 : 26)));
}

// Return how a legend of so many lines, so wide, lies in a picture: in how many columns and rows, how high it
// is, and how much of it stands below the map: all of it where it would lie over the plot.
export function legendPlace(part, n, wide) {
  const narrow = part.width < NARROW_PX && n > 0;
  const columns = narrow && 2 * wide + 3 * PAD <= part.width ? 2 : 1, rows = Math.ceil(n / columns);
  const high = n ? rows * LINE + 2 * PAD - 6 : 0;
  return { columns, rows, high, below: narrow ? high : 0 };
}

function legend(pen, { legend: parts, signs, colours, rtl }, { width, height }, { columns, rows, high, below, wide }) {
  const lines = linesOf(parts ?? []);
  if (!lines.length) return;
  pen.direction = rtl ? "rtl" : "ltr";
  pen.textAlign = rtl ? "right" : "left";
  const all = below ? width : wide + 2 * PAD, left = below ? 0 : rtl ? PAD : width - PAD - all;
  const top = below ? height - high : height - PAD - high;
  if (below) {
    pen.fillStyle = colours.surface;
    pen.fillRect(left, top, all, high);
  } else box(pen, left, top, all, high, colours.surface);
  const way = rtl ? -1 : 1, begins = rtl ? left + all - PAD : left + PAD, each = (all - PAD) / columns;
  lines.forEach((line, k) => {
    const from = begins + way * each * Math.floor(k / rows), y = top + PAD + ((k % rows) + 0.5) * LINE - 3;
    pen.fillStyle = colours.ink;
    pen.font = `${line.title ? "600 " : ""}12px ${FONT}`;
    if (line.title) pen.fillText(line.title, from, y);
    else {
      const sign = signs(line.sign, line.colour);
      if (sign) pen.drawImage(sign, rtl ? from - 16 : from, y - 8, 16, 16);
      pen.fillText(line.text, from + way * 22, y);
    }
  });
}

export function foot(pen, { bar, credit, colours, rtl }, part) {
  pen.direction = "ltr";
  pen.textAlign = "left";
  pen.font = `12px ${FONT}`;
  const y = part.height - PAD - 26, x = rtl ? part.width - PAD - bar.px - 46 : PAD;
  box(pen, x, y, bar.px + 46, 26, colours.surface);
  pen.strokeStyle = pen.fillStyle = colours.ink;
  pen.save();
  pen.translate(x + 14, y + 13);
  pen.rotate((-(bar.bearing ?? 0) * Math.PI) / 180);
  pen.font = `700 20px ${FONT}`;
  pen.textAlign = "center";
  pen.fillText(NORTH, 0, 0);
  pen.restore();
  pen.direction = rtl ? "rtl" : "ltr"; // the bar runs from the left, its words as the language does
  pen.fillText(bar.text, x + 30, y + 9);
  pen.direction = "ltr";
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.moveTo(x + 30, y + 16);
  pen.lineTo(x + 30, y + 21);
  pen.lineTo(x + 30 + bar.px, y + 21);
  pen.lineTo(x + 30 + bar.px, y + 16);
  pen.stroke();
  if (!credit) return;
  const wide = pen.measureText(credit).width + 16, at = rtl ? x - wide - 8 : x + bar.px + 54;
  box(pen, at, y, wide, 26, colours.surface);
  pen.fillStyle = colours.ink;
  pen.fillText(credit, at + 8, y + 14);
}
