// The page's shape: the panel beside the map folds away; on a phone it is a sheet to be pulled up.

import { element } from "./chrome.js";
import style from "./shape.css";

// where a phone's sheet begins, and how far up a tap pulls it
const HALF = 0.58, UP = 0.14, LOW = 0.3;
// a window made narrow has its list of pages a moment later
const LATER_MS = 500;
const KEY = "fieldmon panel";
const page = document.documentElement;

let now = null, measured = null;

function shapeOf() {
  try {
    now ??= JSON.parse(sessionStorage.getItem(KEY)) ?? {};
  } catch {
    now ??= {};
  }
  return now;
}

function keep(shape) {
  try {
    sessionStorage.setItem(KEY, JSON.stringify(shape));
  } catch { /* the shape is then forgotten with the page */ }
}

// Return what the panel covers of the window, in pixels from each side.
export function covered() {
  const panel = document.querySelector(".st-key-panel")?.getBoundingClientRect();
  const none = { left: 0, right: 0, bottom: 0 };
  if (!panel || !panel.width || shapeOf().folded) return none;
  if (panel.width > 0.9 * innerWidth) return { ...none, bottom: Math.max(0, innerHeight - panel.top) };
  return panel.left > innerWidth / 2 ? { ...none, right: innerWidth - panel.left } : { ...none, left: panel.right };
}

// Return whether the panel covers more or less of the window's sides than when it was measured last.
function measure() {
  const { left, right } = covered(), sides = `${left} ${right}`, changed = sides !== measured;
  measured = sides;
  page.style.setProperty("--covers-start", `${left + right}px`);
  return changed;
}

// Streamlit's list of pages, on a phone, has a group in it that is no item, and whose items are then in no list.
export function listed() {
  for (const group of document.querySelectorAll("ul[data-testid=stSidebarNavItems] > div:not([role])")) {
    group.setAttribute("role", "listitem");
    for (const item of group.querySelectorAll("li")) item.setAttribute("role", "none");
  }
}

// Set the panel's handle up; return what fits it to the page again, and what takes it away. Who asks is told
// when the panel covers more or less: another page's may be wider.
export function keepShape(words, told = () => {}) {
  const shape = shapeOf();
  const host = document.body.appendChild(element("div", { class: "fieldmon-shape" }));
  const shadow = host.attachShadow({ mode: "open" });
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(style);
  shadow.adoptedStyleSheets = [sheet];
  const fold = shadow.appendChild(element("button", { type: "button", class: "fold", onclick: () => set({ folded: !shape.folded }) }));
  const grip = shadow.appendChild(element("button", { type: "button", class: "grip" }, [element("i")]));
  const tell = () => { if (measure()) told(); };
  const set = (change) => {
    Object.assign(shape, change);
    keep(shape);
    page.toggleAttribute("data-panel-folded", Boolean(shape.folded));
    // above a sheet that is pulled up there is room for the legend alone: the rest lay on it, or was cut off
    page.style.setProperty("--above-sheet", (shape.sheet ?? HALF) > LOW ? "visible" : "hidden");
    page.style.setProperty("--sheet-top", `${Math.round(100 * (shape.sheet ?? HALF))}dvh`);
    tell();
    setTimeout(() => { listed(); tell(); }, LATER_MS); // the panel may only just be there
    const said = words() ?? {};
    fold.textContent = shape.folded ? "›" : "‹"; // mirrored by itself where one reads from the right
    fold.setAttribute("aria-label", (shape.folded ? said.unfold : said.fold) ?? "");
    fold.setAttribute("aria-expanded", String(!shape.folded));
    grip.setAttribute("aria-label", said.sheet ?? "");
  };
  pull(grip, shape, set);
  set({});
  const again = () => set({});
  window.addEventListener("resize", again);
  const end = () => {
    window.removeEventListener("resize", again);
    host.remove();
  };
  return { again, end };
}

function pull(grip, shape, set) {
  let from = null;
  grip.addEventListener("pointerdown", (event) => {
    from = { y: event.clientY, moved: false };
    grip.setPointerCapture(event.pointerId);
  });
  grip.addEventListener("pointermove", (event) => {
    if (!from) return;
    from.moved ||= Math.abs(event.clientY - from.y) > 5;
    if (from.moved) set({ sheet: Math.min(0.85, Math.max(0.1, event.clientY / innerHeight)) });
  });
  grip.addEventListener("pointerup", () => {
    // a tap pulls the sheet up, or lets it down again
    if (from && !from.moved) set({ sheet: (shape.sheet ?? HALF) > LOW ? UP : HALF });
    from = null;
  });
  grip.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -0.1, ArrowDown: 0.1 }[event.key];
    if (event.key === "Enter" || event.key === " ") set({ sheet: (shape.sheet ?? HALF) > LOW ? UP : HALF });
    else if (step) set({ sheet: Math.min(0.85, Math.max(0.1, (shape.sheet ?? HALF) + step)) });
  });
}
