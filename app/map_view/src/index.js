// The map of fieldmon's app, a component of Streamlit: pydeck's layers on the whole page.
//
// The server sends which layers there are and where their content is; what the browser has, it does
// not fetch again. Switches, opacity, hovering, zooming and drawing are the browser's own and wait
// for nobody. The server hears of what is meant for it: taps, finished drawings, selections.

import { Deck, FlyToInterpolator, MapView } from "@deck.gl/core";

import { button, element, legendOf, Scale } from "./chrome.js";
import { Drawing } from "./draw.js";
import { Frames } from "./frames.js";
import { Labels } from "./labels.js";
import { layersOf } from "./layers.js";
import { nearestPlant, plantsWithin, rowUnder } from "./pick.js";
import { Playback } from "./playback.js";
import { covered, keepShape } from "./shape.js";
import * as store from "./store.js";
import style from "./style.css";
import { fitted, metresPerPixel } from "./view.js";

const STILL_PX = 6, TWICE_MS = 350, TIP_PX = 12, FLY_MS = 600;

class MapPage {
  constructor(parent) {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
    const root = parent.getRootNode();
    root.adoptedStyleSheets = [...(root.adoptedStyleSheets ?? []), sheet];
    this.canvasPlace = element("div", { class: "canvas" });
    this.labelPlace = element("div", { class: "labels", "aria-hidden": "true" });
    this.tip = element("div", { class: "tip", hidden: true });
    this.tools = element("div", { class: "tools", role: "toolbar" });
    this.card = element("div", { class: "card", hidden: true });
    this.legend = element("div", { class: "legend" });
    this.bar = element("div", { class: "drawbar", hidden: true });
    this.foot = element("div", { class: "foot" });
    this.root = parent.appendChild(element("div", { class: "map" }, [
      this.canvasPlace, this.labelPlace, this.tools, this.card, this.legend, this.foot, this.bar, this.tip]));
    this.scale = new Scale(this.foot);
    this.labels = new Labels(this.labelPlace);
    this.playback = new Playback(this.foot, () => this.drawLayers());
    this.frames = new Frames(this.foot, () => this.drawLayers(), () => this.canvasPlace.querySelector("canvas"));
    this.drawing = new Drawing(() => this.drawLayers(), (mode, points) => this.drawn(mode, points));
    this.jsons = [];
    this.hidden = new Set();
    this.opacity = 1;
    this.shape = keepShape(() => this.data?.words);
    this.listen();
  }

  // -- what the server sends

  async show({ data, setTriggerValue }) {
    this.data = data;
    this.tell = setTriggerValue;
    const turn = (this.turn = (this.turn ?? 0) + 1);
    this.speak(data);
    this.restore();
    this.shape.again(); // another room's panel may be wider, and now there are words
    this.root.classList.toggle("dark", data.dark);
    this.canvasPlace.setAttribute("aria-label", data.alt);
    this.furnish();
    this.drawing.begin(data.draw ?? null);
    this.drawBar();
    let jsons;
    try {
      jsons = await Promise.all(data.layers.map(store.layer));
    } catch {
      // the server has let go of something: it makes it again when asked
      if (turn === this.turn) this.tell("missing", turn);
      return;
    }
    if (turn !== this.turn) return;
    this.jsons = jsons;
    this.playback.show(data.frames ? null : data.play ?? null, data.words);
    this.frames.show(data.frames ?? null, data.words);
    this.look();
    this.drawLayers();
    this.root.dataset.shown = data.layers.map((one) => one.url).join(" ");
  }

  // the page reads in the language of its words; the panel's handle is then on the other side
  speak({ language, direction }) {
    const page = document.documentElement, turned = page.dir !== direction;
    page.lang = language;
    page.dir = direction;
    if (turned) window.dispatchEvent(new Event("resize"));
  }

  look() {
    const { bounds, place } = this.data;
    if (!this.deck) {
      this.open(bounds);
    } else if (place !== this.place) {
      const view = this.fit();
      this.deck.setProps({ initialViewState: { ...view, maxZoom: 24, transitionDuration: this.place ? FLY_MS : 0,
        transitionInterpolator: new FlyToInterpolator({ speed: 4 }) } });
    }
    this.place = place;
  }

  fit() {
    return fitted(this.data.bounds, this.size(), this.padding());
  }

  size() {
    const box = this.canvasPlace.getBoundingClientRect();
    return { width: Math.max(box.width, 50), height: Math.max(box.height, 50) };
  }

  padding() {
    const { left, right, bottom } = covered();
    return { left: left + 30, right: right + 64, top: 24, bottom: bottom + 56 };
  }

  open() {
    this.deck = new Deck({
      parent: this.canvasPlace,
      views: new MapView({ id: "map", repeat: false }),
      controller: { keyboard: true, doubleClickZoom: true },
      initialViewState: { ...this.fit(), maxZoom: 24 },
      layers: [],
      pickingRadius: 0,
      _pickable: false,
      getCursor: ({ isDragging }) => (isDragging ? "grabbing" : this.drawing.mode ? "crosshair" : "grab"),
      onViewStateChange: ({ viewState }) => this.limited(viewState),
      onAfterRender: () => { this.follow(); this.frames.drawn(); },
    });
    this.watch = new ResizeObserver(() => this.resized());
    this.watch.observe(this.canvasPlace);
  }

  limited(view) {
    // tilting is of no use on a plan, and turning it loses north
    return { ...view, pitch: 0 };
  }

  // a window that changes its size before anybody moved the map shows the whole plot again
  resized() {
    if (this.deck && !this.moved) this.deck.setProps({ initialViewState: { ...this.fit(), maxZoom: 24 } });
  }

  // -- drawing

  drawLayers() {
    if (!this.deck) return;
    const accent = this.data.dark ? [255, 220, 90] : [0, 110, 70];
    const jsons = [...this.frames.of(this.jsons), ...this.playback.layers(this.data.dark), ...this.drawing.layers(accent)];
    const hidden = new Set(this.off().flatMap((name) => this.switchOf(name)?.layers ?? []));
    for (const name of this.data.shades?.flatMap((one) => (one.key === this.shade() ? [] : one.layers)) ?? []) hidden.add(name);
    this.deck.setProps({ layers: layersOf(jsons, hidden, this.opacity) });
    this.drawBar();
    this.follow();
  }

  follow() {
    const viewport = this.viewport();
    if (!viewport) return;
    this.scale.draw(viewport, { lengths: this.data.lengths, alt: this.data.words.scale });
    this.labels.draw(this.data.labels ?? [], viewport, new Set(this.off()));
    const { longitude, latitude, zoom, width, height } = viewport;
    this.root.dataset.view = JSON.stringify({ longitude, latitude, zoom, width, height });
  }

  viewport() {
    return this.deck?.isInitialized ? this.deck.getViewports()[0] : null;
  }

  // -- switches

  switchOf(name) {
    return this.data.switches?.find((one) => one.key === name);
  }

  off() {
    return [...this.hidden, ...this.frames.hides];
  }

  shade() {
    const keys = this.data.shades?.map((one) => one.key) ?? [];
    return keys.includes(this.shaded) ? this.shaded : keys[0];
  }

  restore() {
    if (this.restored) return;
    this.restored = true;
    try {
      const kept = JSON.parse(sessionStorage.getItem("fieldmon map") ?? "{}");
      this.touched = new Set(kept.touched ?? []);
      this.hidden = new Set(kept.hidden ?? []);
      this.opacity = kept.opacity ?? 1;
      this.shaded = kept.shade;
    } catch {
      this.touched = new Set();
    }
  }

  keep() {
    const kept = { touched: [...this.touched], hidden: [...this.hidden], opacity: this.opacity, shade: this.shaded };
    try {
      sessionStorage.setItem("fieldmon map", JSON.stringify(kept));
    } catch { /* a browser that keeps nothing still shows everything */ }
  }

  // -- what lies on the map

  furnish() {
    const { words, switches, shades, legend } = this.data;
    for (const { key, off } of switches ?? []) {
      // what nobody has switched is as each page wants it
      if (this.touched.has(key)) continue;
      if (off) this.hidden.add(key);
      else this.hidden.delete(key);
    }
    const now = JSON.stringify([words, switches, shades, legend, this.data.select]);
    if (now === this.furnished) return;
    this.furnished = now;
    this.tools.replaceChildren(
      button("plus", words.zoom_in, () => this.zoom(1)),
      button("minus", words.zoom_out, () => this.zoom(-1)),
      button("fit", words.whole_plot, () => this.whole()),
      button("layers", words.layers, () => this.openCard(), { "aria-expanded": String(!this.card.hidden), class: "tool layers" }),
      ...(this.data.select ? [button("lasso", words.select, () => this.lasso())] : []),
      button("shot", words.picture, () => this.shoot()),
    );
    this.card.replaceChildren(...this.switchboard());
    this.showLegend();
  }

  switchboard() {
    const { words, switches, shades } = this.data;
    const parts = [];
    if (shades?.length > 1) {
      parts.push(element("div", { class: "title", text: words.shade }));
      for (const { key, label } of shades) {
        const box = element("input", { type: "radio", name: "shade", value: key, checked: key === this.shade(),
          onchange: () => { this.shaded = key; this.keep(); this.showLegend(); this.drawLayers(); } });
        parts.push(element("label", {}, [box, element("span", { text: label })]));
      }
    }
    parts.push(element("div", { class: "title", text: words.layers }));
    for (const { key, label } of switches ?? []) {
      const box = element("input", { type: "checkbox", checked: !this.hidden.has(key), onchange: () => {
        this.touched.add(key);
        if (box.checked) this.hidden.delete(key); else this.hidden.add(key);
        this.keep();
        this.showLegend();
        this.drawLayers();
      } });
      parts.push(element("label", {}, [box, element("span", { text: label })]));
    }
    const slider = element("input", { type: "range", min: 0.1, max: 1, step: 0.05, value: this.opacity,
      "aria-label": words.opacity, oninput: () => { this.opacity = Number(slider.value); this.keep(); this.drawLayers(); } });
    parts.push(element("label", { class: "wide" }, [element("span", { text: words.opacity }), slider]));
    return parts;
  }

  openCard() {
    this.card.hidden = !this.card.hidden;
    this.tools.querySelector(".layers").setAttribute("aria-expanded", String(!this.card.hidden));
    if (!this.card.hidden) this.card.querySelector("input")?.focus();
  }

  showLegend() {
    const shown = (this.data.legend ?? []).filter(({ of }) =>
      !of || of === `shade:${this.shade()}` || (this.switchOf(of) && !this.hidden.has(of)));
    this.legend.replaceChildren(...legendOf(shown));
    this.legend.hidden = !shown.length;
  }

  zoom(by) {
    const view = this.viewport();
    if (!view) return;
    this.moved = true;
    const { longitude, latitude, zoom, bearing } = view;
    this.deck.setProps({ initialViewState: { longitude, latitude, bearing, pitch: 0, maxZoom: 24,
      zoom: Math.min(24, zoom + by), transitionDuration: 200 } });
  }

  whole() {
    this.moved = false;
    this.deck?.setProps({ initialViewState: { ...this.fit(), maxZoom: 24, transitionDuration: 300 } });
  }

  shoot() {
    if (!this.deck) return;
    this.deck.redraw("picture");
    this.canvasPlace.querySelector("canvas").toBlob((blob) => {
      const link = element("a", { href: URL.createObjectURL(blob), download: this.data.words.picture_name });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }

  // -- drawing and selecting

  lasso() {
    const on = this.drawing.mode?.kind === "lasso";
    this.drawing.begin(on ? (this.data.draw ?? null) : { kind: "lasso", id: "lasso" });
    this.drawBar();
  }

  drawn(mode, points) {
    if (mode.kind !== "lasso") {
      this.tell("drawn", { kind: mode.id, points });
      return;
    }
    const places = this.jsons.find((one) => one.places)?.places;
    this.drawing.begin(this.data.draw ?? null);
    if (places) this.tell("selected", { plants: plantsWithin(places, points).slice(0, 5000) });
  }

  drawBar() {
    const { mode, points, ready } = this.drawing;
    this.root.classList.toggle("drawing", Boolean(mode));
    const now = JSON.stringify([mode?.id, points.length, this.data.words]);
    if (now === this.barred) return;
    this.barred = now;
    this.bar.hidden = !mode;
    if (!mode) return;
    const { words } = this.data;
    const press = (label, act, more = {}) => element("button", { type: "button", text: label, onclick: act, ...more });
    const hint = mode.kind === "lasso" ? words.lasso_hint : mode.hint ?? words.draw_hint;
    this.bar.replaceChildren(
      element("span", { text: points.length && mode.kind !== "bent" ? words.corners.replace("{n}", points.length) : hint }),
      press(words.draw_back, () => this.drawing.undo(), { disabled: !points.length }),
      press(words.draw_drop, () => { this.drawing.drop(); if (mode.kind === "lasso") this.lasso(); }),
      ...(["point", "lasso", "bent"].includes(mode.kind) ? [] : [press(words.draw_done, () => this.drawing.finish(), { disabled: !ready, class: "main" })]),
    );
  }

  // -- the pointer

  listen() {
    const place = this.canvasPlace;
    place.setAttribute("role", "img");
    place.addEventListener("pointerdown", (event) => this.pressed(event), true);
    place.addEventListener("pointermove", (event) => this.hovered(event), true);
    place.addEventListener("pointerup", (event) => this.released(event), true);
    place.addEventListener("pointerleave", () => { this.tip.hidden = true; });
    place.addEventListener("wheel", () => { this.moved = true; this.tip.hidden = true; }, { passive: true, capture: true });
    place.addEventListener("keydown", () => { this.moved = true; });
    this.root.addEventListener("keydown", (event) => this.typed(event));
  }

  typed(event) {
    if (!this.drawing.mode) return;
    if (event.key === "Escape") this.drawing.drop();
    else if (event.key === "Backspace") this.drawing.undo();
    else if (event.key === "Enter" && event.target.closest(".canvas")) this.drawing.finish();
  }

  at(event) {
    const box = this.canvasPlace.getBoundingClientRect();
    return this.viewport()?.unproject([event.clientX - box.left, event.clientY - box.top]);
  }

  pressed(event) {
    this.tip.hidden = true;
    this.down = event;
    const here = this.at(event);
    if (!here || !this.drawing.mode || event.button) return;
    if (this.drawing.mode.kind === "lasso") {
      this.drawing.drop();
      this.trailing = true;
    } else {
      this.held = this.drawing.grabbed(here, this.viewport());
    }
    if (this.trailing || this.held >= 0) event.stopPropagation();
  }

  hovered(event) {
    const here = this.at(event);
    if (!here) return;
    if (this.trailing || this.held >= 0) {
      event.stopPropagation();
      if (this.trailing) this.drawing.trail(here);
      else this.drawing.move(this.held, here, this.viewport());
      return;
    }
    if (event.buttons) {
      this.moved = true;
      return;
    }
    if (event.pointerType !== "touch") this.point(event, here);
  }

  released(event) {
    const from = this.down, before = this.last, { trailing, held } = this;
    this.down = null;
    this.trailing = false;
    this.held = -1;
    if (trailing) {
      this.drawing.finish();
      return;
    }
    if (held >= 0) {
      this.drawing.told();
      return;
    }
    const near = (one) => Math.hypot(event.clientX - one.clientX, event.clientY - one.clientY);
    const here = this.at(event);
    if (!here || !from || event.button || near(from) > STILL_PX) return;
    this.last = event;
    // the second half of a double click, which zooms
    if (before && event.timeStamp - before.timeStamp < TWICE_MS && near(before) < STILL_PX) return;
    if (this.drawing.mode) {
      this.drawing.click(here, this.viewport());
      return;
    }
    const hit = this.under(here);
    this.point(event, here);
    if (hit && this.data.taps) this.tell("tapped", { layer: hit.id, index: hit.index });
  }

  // Return what lies under a place: {id, index, text}, the topmost first; null for the ground.
  under(here) {
    const reachM = TIP_PX * metresPerPixel(this.viewport());
    const shown = new Set(this.deck.props.layers.filter((layer) => layer.props.visible).map((layer) => layer.id));
    for (const json of this.frames.of(this.jsons).toReversed()) {
      if (!shown.has(json.id)) continue;
      if (json.places) {
        const k = nearestPlant(json.places, here, Math.max(json.radius, Math.min(reachM, 0.6 * json.apart)));
        if (k >= 0) return { id: json.id, index: k, text: tipOf(json, k) };
      } else if (Array.isArray(json.data)) {
        const k = rowUnder(json.data, here, reachM);
        if (k >= 0) return { id: json.id, index: k, text: json.data[k].t };
      }
    }
    return null;
  }

  point(event, here) {
    const hit = this.deck && !this.drawing.mode ? this.under(here) : null;
    this.tip.hidden = !hit?.text;
    if (this.tip.hidden) return;
    const box = this.root.getBoundingClientRect();
    this.tip.textContent = hit.text;
    const x = Math.min(event.clientX - box.left + 14, box.width - this.tip.offsetWidth - 8);
    const y = Math.min(event.clientY - box.top + 14, box.height - this.tip.offsetHeight - 8);
    this.tip.style.transform = `translate(${Math.max(8, x)}px, ${Math.max(8, y)}px)`;
  }

  end() {
    this.playback.stop();
    this.frames.stop();
    this.watch?.disconnect();
    this.shape.end();
    this.deck?.finalize();
    this.root.remove();
  }
}

function tipOf({ places, ranks, values, tips }, k) {
  const note = tips.values ? tips.values.replace("{chance}", `${(100 * values[k]).toFixed(1)} %`) : tips.ranks?.[ranks[k]] ?? "";
  const known = { row: places.row[k], plant: places.number[k], note };
  return tips.text.replace(/\{(\w+)\}/g, (_, name) => known[name]);
}

export function mount(component) {
  const { parentElement } = component;
  parentElement.mapPage ??= new MapPage(parentElement);
  parentElement.mapPage.show(component);
  return () => {
    parentElement.mapPage?.end();
    parentElement.mapPage = null;
  };
}
