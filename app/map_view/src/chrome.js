// What lies on the map: scale and north, zoom, layers, legend, drawing, and what is pointed at.

import { metresPerPixel } from "./view.js";

const LONGEST_PX = 120;
// long, so that it is seen whichever way it points: a triangle looks upright at every 120 degrees
export const NORTH = "↑";
const ICONS = {
  plus: "M11 5h2v6h6v2h-6v6h-2v-6H5v-2h6z",
  minus: "M5 11h14v2H5z",
  fit: "M4 4h6v2H6v4H4zm10 0h6v6h-2V6h-4zM4 14h2v4h4v2H4zm14 0h2v6h-6v-2h4z",
  layers: "M12 3l9 5-9 5-9-5zm-7 9l7 4 7-4 2 1-9 5-9-5zm0 4l7 4 7-4 2 1-9 5-9-5z",
  lasso: "M12 4c5 0 9 2.7 9 6s-4 6-9 6c-1 0-2-.1-2.9-.3.2 1.6-.4 3.200-2.1 4.3l-1-1.7c1-.7 1.300-1.600 1-2.5C4.600 14.700 3 12.5 3 10c0-3.300 4-6 9-6zm0 2c-4 0-7 2-7 4s3 4 7 4 7-2 7-4-3-4-7-4z",
  rows: "M4 5h16v3H4zm0 5.500h16v3H4zM4 16h16v3H4z",
  here: "M11 2h2v3.100A7 7 0 0118.900 11H22v2h-3.100A7 7 0 0113 18.900V22h-2v-3.100A7 7 0 015.100 13H2v-2h3.100A7 7 0 0111 5.100zm1 5a5 5 0 100 10 5 5 0 000-10zm0 3a2 2 0 110 4 2 2 0 010-4z",
  more: "M5 10h4v4H5zm5.5 0h4v4h-4zM16 10h4v4h-4z",
  shot: "M9 4h6l1.5 2H20v14H4V6h3.5zm3 5a4 4 0 100 8 4 4 0 000-8z",
};

export function element(kind, attributes = {}, children = []) {
  const made = document.createElement(kind);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "text") made.textContent = value;
    else if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

export function icon(name) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  made.setAttribute("viewBox", "0 0 24 24");
  made.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", ICONS[name]);
  path.setAttribute("fill", "currentColor");
  made.append(path);
  return made;
}

export function button(name, label, press, more = {}) {
  return element("button", { type: "button", class: "tool", title: label, "aria-label": label, onclick: press, ...more },
    [icon(name)]);
}

// The scale bar and the north arrow, which follow the view.
export class Scale {
  constructor(place) {
    this.bar = element("div", { class: "bar" });
    this.text = element("div", { class: "text" });
    this.north = element("div", { class: "north", text: NORTH });
    this.root = place.appendChild(element("div", { class: "scale", role: "img" }, [
      this.north, element("div", {}, [this.text, this.bar])]));
  }

  draw(viewport, { lengths, alt }) {
    const metre = 1 / metresPerPixel(viewport);
    const fits = lengths.filter(([metres]) => metres * metre <= LONGEST_PX);
    const [metres, text] = fits.length ? fits[fits.length - 1] : lengths[0];
    const { bearing = 0 } = viewport;
    this.length = { px: metres * metre, text, bearing };
    this.bar.style.width = `${metres * metre}px`;
    this.text.textContent = text;
    this.north.style.transform = `rotate(${-bearing}deg)`;
    this.root.setAttribute("aria-label", alt.replace("{bar}", text));
  }
}

const SIGNS = {
  square: (c) => `<rect x="1" y="1" width="14" height="14" rx="2" fill="${c}"/>`,
  dot: (c) => `<circle cx="8" cy="8" r="5" fill="${c}"/>`,
  ring: (c) => `<circle cx="8" cy="8" r="5" fill="none" stroke="${c}" stroke-width="2"/>`,
  find: (c) => `<circle cx="8" cy="8" r="6.5" fill="#fff" stroke="#140000" stroke-width="2"/><circle cx="8" cy="8" r="4" fill="${c}"/>`,
  area: (c) => `<rect x="1" y="1" width="14" height="14" rx="2" fill="${c}" stroke="#8a8f84"/>`,
  hatch: (c) => `<path d="M1 15L15 1M1 8L8 1M8 15l7-7" stroke="${c}" stroke-width="2"/>`,
  line: (c) => `<path d="M1 8h14" stroke="${c}" stroke-width="4"/>`,
  outline: (c) => `<rect x="2" y="2" width="12" height="12" rx="4" fill="none" stroke="${c}" stroke-width="2.5"/>`,
};

// Return a sign as a picture that a canvas can draw, once it is loaded.
export function signPicture(kind, colour) {
  const made = new Image();
  const shape = SIGNS[kind](`rgb(${colour.map(Number).join(",")})`);
  made.src = `data:image/svg+xml,${encodeURIComponent(`<svg xmlns="http://www.w3.org/2000/svg" width="32" height="32" viewBox="0 0 16 16">${shape}</svg>`)}`;
  return made;
}

function sign(kind, colour) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  made.setAttribute("viewBox", "0 0 16 16");
  made.setAttribute("aria-hidden", "true");
  // both are this file's own: shapes above, and three numbers
  made.innerHTML = SIGNS[kind](`rgb(${colour.map(Number).join(",")})`);
  return made;
}

// Return the legend: [{title, scale?: bool, items: [[sign, colour, text], ...]}, ...].
export function legendOf(parts) {
  return parts.map(({ title, scale, items }) => {
    if (!scale) {
      return element("div", { class: "part" }, [
        title && element("div", { class: "title", text: title }),
        ...items.map(([kind, colour, text]) =>
          element("div", { class: "item" }, [sign(kind, colour), element("span", { text })])),
      ].filter(Boolean));
    }
    return element("div", { class: "part scaled" }, [
      element("div", { class: "title", text: title }),
      element("div", { class: "steps" }, items.map(([, colour, text]) => {
        const box = element("span", { class: "step" }, [element("i"), element("span", { text })]);
        box.firstChild.style.background = `rgb(${colour.map(Number).join(",")})`;
        return box;
      })),
    ]);
  });
}
