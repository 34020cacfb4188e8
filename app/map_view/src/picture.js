// The map as a picture of its own, for a report: what the panel leaves free, with what lies on it.

const PAD = 12, LINE = 18, FONT = "system-ui, sans-serif";

// Return the part of the map that is taken: what panels leave free, in CSS pixels.
export function freePart({ width, height }, { left, right, bottom }) {
  return { x: left, y: 0, width: Math.max(50, width - left - right), height: Math.max(50, height - bottom) };
}

// Draw the map with its words, legend and scale.
//
// `shot` is {canvas, size, part, colours: {ground, surface, ink, route}, title, credit, legend: [{title, scale, items}],
// signs (sign and colour to image), labels: [{x, y, t, k}], bar: {px, text}, rtl, most, onPicture}; returns a canvas.
export function composed(shot) {
  const { canvas, size, part, colours } = shot;
  const ratio = Math.min(canvas.width / size.width, (shot.most ?? 4000) / part.width);
  const made = document.createElement("canvas");
  made.width = Math.round(part.width * ratio);
  made.height = Math.round(part.height * ratio);
  const pen = made.getContext("2d");
  pen.scale(ratio, ratio);
  pen.fillStyle = colours.ground;
  pen.fillRect(0, 0, part.width, part.height);
  const own = canvas.width / size.width;
  pen.drawImage(canvas, part.x * own, part.y * own, part.width * own, part.height * own, 0, 0, part.width, part.height);
  pen.textBaseline = "middle";
  for (const label of shot.labels ?? []) {
    word(pen, { ...label, x: label.x - part.x, y: label.y - part.y }, colours, shot.onPicture);
  }
  if (shot.title) title(pen, shot, part);
  legend(pen, shot, part);
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
  pen.font = `600 20px ${FONT}`;
  pen.direction = rtl ? "rtl" : "ltr";
  const wide = pen.measureText(said).width + 2 * PAD, x = rtl ? part.width - PAD - wide : PAD;
  box(pen, x, PAD, wide, 36, colours.surface);
  pen.fillStyle = colours.ink;
  pen.textAlign = "center";
  pen.fillText(said, x + wide / 2, PAD + 19);
}

// Return the lines of a legend: a sign and its words each; a scale is one line a class.
export function linesOf(parts) {
  return parts.flatMap(({ title: said, items }) => [
    ...(said ? [{ title: said }] : []),
    ...items.map(([sign, colour, text]) => ({ sign, colour, text })),
  ]);
}

function legend(pen, { legend: parts, signs, colours, rtl }, part) {
  const lines = linesOf(parts ?? []);
  if (!lines.length) return;
  pen.direction = rtl ? "rtl" : "ltr";
  pen.textAlign = rtl ? "right" : "left";
  pen.font = `12px ${FONT}`;
  const wide = Math.max(...lines.map((line) => pen.measureText(line.title ?? line.text).width + (line.title ? 8 : 26))) + 2 * PAD;
  const high = lines.length * LINE + 2 * PAD - 6;
  const left = rtl ? PAD : part.width - PAD - wide, top = part.height - PAD - high;
  box(pen, left, top, wide, high, colours.surface);
  const from = rtl ? left + wide - PAD : left + PAD, way = rtl ? -1 : 1;
  lines.forEach((line, k) => {
    const y = top + PAD + (k + 0.5) * LINE - 3;
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
  pen.fillText("▲", x + 8, y + 14);
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
