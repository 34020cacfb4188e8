// The map of fieldmon's app, a component of Streamlit: pydeck's layers on the whole page.
//
// The server sends which layers there are and where their content is; what the browser has, it does
// not fetch again. Switches, opacity, hovering, zooming and drawing are the browser's own and wait
// for nobody. The server hears of what is meant for it: taps, finished drawings, selections.

import { Deck, FlyToInterpolator, MapView } from "@deck.gl/core";

import { keepOneStep } from "./address.js";
import { button, element, legendOf, Scale, signPicture } from "./chrome.js";
import { takeDays } from "./days.js";
import { takeCommas } from "./decimals.js";
import { Dots, MARKS, dotUnder } from "./dots.js";
import { Drawing } from "./draw.js";
import { Drive } from "./drive.js";
import { Frames } from "./frames.js";
import { asked, moved } from "./keys.js";
import { Labels, nameBoxes, rowBoxes, withHot } from "./labels.js";
import { layersOf } from "./layers.js";
import { letNoticesGo } from "./notice.js";
import { Pace } from "./pace.js";
import { nearestPlant, plantsWithin, rowsUnder, tipOf } from "./pick.js";
import { composed, freePart } from "./picture.js";
import { Playback } from "./playback.js";
import { ofRuns, runsOf, withRow } from "./select.js";
import { covered, keepShape, listed } from "./shape.js";
import * as store from "./store.js";
import style from "./style.css";
import { oneTapEach } from "./taps.js";
import { waitForBoxes } from "./turning.js";
import { keepUnfinished } from "./unfinished.js";
import { besideBox, fitted, metresPerPixel } from "./view.js";

const STILL_PX = 6, TWICE_MS = 350, TIP_PX = 12, FLY_MS = 600, TURN_MS = 300;
const NONE = [], ASLANT = "aslant";
const DARK = matchMedia("(prefers-color-scheme: dark)");
// a GIF of more pixels is too large to be sent; more plants at once are no selection
const FILM_PX = 1100, MOST_PICKED = 20000;
// the legend stays so far from plants; so many of them are asked
const MARGIN_PX = 8, MOST_ASKED = 4000;
// so many of the plots under one dot are said where it is pointed at
const MOST_SAID = 6;
// from farther away a tap is no corner of a plot; nor is a position that is less exact
const CORNER_M_A_PX = 5, CORNER_M = 30, WAIT_MS = 20000, NEAR_ZOOM = 18;

// What may bring another picture: what is set, and a hand on the map.
const HANDS = ["pointerdown", "pointermove", "pointerup", "pointerleave", "wheel", "touchstart", "touchmove", "touchend", "keydown"];

class PacedDeck extends Deck {
  setProps(props) {
    super.setProps(props);
    this.props.animationFrameProvider?.wake();
  }
}

export class MapPage {
  constructor(parent) {
    takeCommas();
    takeDays();
    keepOneStep();
    letNoticesGo();
    waitForBoxes();
    keepUnfinished();
    oneTapEach();
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
    const root = parent.getRootNode();
    root.adoptedStyleSheets = [...(root.adoptedStyleSheets ?? []), sheet];
    this.canvasPlace = element("div", { class: "canvas" });
    this.labelPlace = element("div", { class: "labels", "aria-hidden": "true" });
    this.tip = element("div", { class: "tip", hidden: true });
    this.cross = element("div", { class: "cross", hidden: true, "aria-hidden": "true" });
    this.heard = element("div", { class: "heard", role: "status" });
    this.credit = element("div", { class: "credit", hidden: true });
    this.tools = element("div", { class: "tools", role: "toolbar" });
    this.card = element("div", { class: "card", hidden: true });
    this.choice = element("div", { class: "choice", role: "group", hidden: true });
    this.legend = element("div", { class: "legend" });
    this.bar = element("div", { class: "drawbar", hidden: true });
    this.foot = element("div", { class: "foot" });
    this.root = parent.appendChild(element("div", { class: "map" }, [
      this.canvasPlace, this.labelPlace, this.tools, this.card, this.legend, this.foot, this.bar, this.cross, this.tip, this.choice, this.heard]));
    this.scale = new Scale(this.foot);
    this.pace = new Pace((rests) => this.root.toggleAttribute("data-resting", rests));
    this.labels = new Labels(this.labelPlace);
    this.dots = new Dots();
    this.playback = new Playback(this.foot, () => this.drawLayers());
    this.frames = new Frames(this.foot, { changed: () => this.drawLayers(), save: (blob, name) => saved(blob, name),
      shot: async (day) => { await this.rendered(); return this.shot(day, FILM_PX); },
      gone: () => this.tell("missing", this.turn), called: () => this.data.title ?? "" });
    this.drive = new Drive(this.foot, () => this.drawLayers());
    this.foot.append(this.credit);
    this.drawing = new Drawing(() => this.drawLayers(), (mode, points) => this.drawn(mode, points));
    this.jsons = [];
    this.hidden = new Set();
    this.opacity = 1;
    this.groundOpacity = 1;
    this.signs = new Map();
    this.waiting = [];
    this.shape = keepShape(() => this.data?.words, () => this.resized());
    this.listen();
  }

  // -- what the server sends

  async show({ data, setTriggerValue }) {
    this.data = data;
    this.tell = setTriggerValue;
    delete this.root.dataset.shown; // until it is
    this.choice.hidden = true;
    const turn = (this.turn = (this.turn ?? 0) + 1);
    this.speak(data);
    this.restore();
    this.shape.again(); // another page's panel may be wider, and now there are words
    this.root.classList.toggle("dark", data.dark);
    this.root.classList.toggle("selects", Boolean(data.select));
    this.canvasPlace.setAttribute("aria-label", data.words.keys);
    this.canvasPlace.querySelector("canvas")?.setAttribute("aria-label", data.alt);
    this.picked = ofRuns(data.picked ?? []);
    this.showGround(data);
    this.furnish();
    // who selects rows goes on, though the server has drawn what is selected so far
    if (!data.select || this.drawing.mode?.kind !== "rows") this.drawing.begin(data.draw ?? null);
    this.drawBar();
    const got = await store.persist(
      () => Promise.all([data.drive && store.json(data.drive), ...data.layers.map(store.layer)]),
      () => turn === this.turn,
      // the server had let go of something: it makes it again when asked
      () => this.tell("missing", turn),
    );
    if (got === null) return;
    const [driven, ...jsons] = got;
    this.jsons = jsons;
    this.playback.show(data.frames ? null : data.play ?? null, data.words);
    this.frames.show(data.frames ?? null, data.words);
    this.root.classList.toggle(ASLANT, Boolean(driven));
    this.drive.show(driven ?? null, data.words, data.drive);
    this.look();
    this.drawLayers();
    this.root.dataset.shown = data.layers.map((one) => one.url).join(" ");
  }

  // the page reads in the language of its words; the panel's handle is then on the other side
  speak({ language, direction, working }) {
    const page = document.documentElement, turned = page.dir !== direction;
    const said = JSON.stringify(working); // for a wait: see every_page.css
    // written where it is another: the browser lays the whole page out again for it
    if (page.lang !== language) page.lang = language;
    if (turned) page.dir = direction;
    if (page.style.getPropertyValue("--working") !== said) page.style.setProperty("--working", said);
    listed();
    if (turned) window.dispatchEvent(new Event("resize"));
  }

  look() {
    const { bounds, drive } = this.data, place = `${this.data.place} ${drive ? ASLANT : ""}`;
    if (!this.deck) {
      this.open(bounds);
    } else if (place !== this.place) {
      this.tip.hidden = true; // it is of what is no longer shown
      const view = this.fit();
      this.moved = false; // who followed a robot moved another map
      // after a drive there is no flight: `limited` makes the map flat, which ends it at the first step, still turned
      const flies = this.place && !this.place.endsWith(ASLANT);
      this.deck.setProps({ initialViewState: { ...view, maxZoom: 24, transitionDuration: flies ? FLY_MS : 0,
        transitionInterpolator: new FlyToInterpolator({ speed: 4 }) } });
    } else if (!drive) {
      const before = this.whence;
      this.fit();
      if (this.whence !== before) this.resized(); // the legend may be larger than it was
    }
    this.place = place;
  }

  fit() {
    const rows = this.off().includes("rows") ? NONE : this.data.labels ?? NONE;
    const words = (port) => [...rowBoxes(rows, port), ...nameBoxes(new Dots().labels(this.data.labels ?? NONE, this.jsons, port), port)];
    const view = besideBox(this.data.bounds, this.size(), this.padding(), this.legendBox(), this.somePlaces(), words);
    this.whence = JSON.stringify(view);
    return this.data.drive ? { ...view, pitch: this.drive.pitch() } : view;
  }

  size() {
    const box = this.canvasPlace.getBoundingClientRect();
    return { width: Math.max(box.width, 50), height: Math.max(box.height, 50) };
  }

  padding() {
    const { offsetWidth: wide, offsetHeight: tall, offsetTop } = this.tools;
    const inRow = wide > tall; // in a low window, above the plot
    const { left, right, bottom } = covered(), tools = [30, inRow ? 30 : wide + 24];
    const top = Math.max(this.top(), inRow ? offsetTop + tall + MARGIN_PX : 0);
    if (this.data.direction === "rtl") tools.reverse();
    // below the plot, the gate's name has room above the day's bar
    return this.clearOfBar({ left: left + tools[0], right: right + tools[1], top, bottom: bottom + 76 });
  }

  // Return the padding that leaves free what is drawn, too: its bar lies above it, or on a phone below.
  clearOfBar(padding) {
    if (this.bar.hidden) return padding;
    const bar = this.bar.getBoundingClientRect(), map = this.root.getBoundingClientRect();
    const above = bar.top - map.top < bar.height, side = above ? "top" : "bottom";
    const reach = above ? bar.bottom - map.top : map.bottom - bar.top;
    return { ...padding, [side]: Math.max(padding[side], reach + MARGIN_PX) };
  }

  // Return from where the map is free: on a phone the legend lies above the plot.
  top() {
    const legend = this.legend.getBoundingClientRect(), map = this.root.getBoundingClientRect();
    const above = legend.width > map.width / 3 && !this.legendBox(); // folded it is a sign in the corner
    return above ? Math.max(24, legend.bottom - map.top + MARGIN_PX) : 24;
  }

  // Return the boxes of what lies over the map, and from where to where it is seen beside the panel; asked
  // anew whenever that may have changed.
  around() {
    if (this.boxes) return this.boxes;
    const map = this.root.getBoundingClientRect(), { left, right } = covered();
    const over = [...this.foot.children, this.legend, this.tools].map((one) => one.getBoundingClientRect()).filter((box) => box.width)
      .map((box) => [box.left - map.left, box.top - map.top, box.right - map.left, box.bottom - map.top]);
    this.boxes = [over, [left, map.width - right]];
    return this.boxes;
  }

  // Return where the legend lies on the map; null where it lies above the plot, as on a phone.
  legendBox() {
    const box = this.legend.getBoundingClientRect(), map = this.root.getBoundingClientRect();
    if (!box.width || box.bottom - map.top < map.height / 2) return null;
    const [x, y] = [map.left + MARGIN_PX, map.top + MARGIN_PX];
    return { left: box.left - x, right: box.right - map.left + MARGIN_PX, top: box.top - y, bottom: map.height };
  }

  // Return places of plants, not too many, and of the plot's corners: whether something hides them is asked
  // of each. Where all plots are shown, there are none: then the places of their names.
  somePlaces() {
    const places = this.places(), some = [];
    if (!places) return (this.data.labels ?? []).filter(({ k }) => k === "name").map(({ p }) => p);
    const step = Math.ceil(places.lon.length / MOST_ASKED);
    for (let k = 0; k < places.lon.length; k += step) some.push([places.lon[k], places.lat[k]]);
    const rings = (this.jsons.find(({ id }) => id === "boundary")?.data ?? NONE).map(({ path }) => path);
    const corners = rings.reduce((n, path) => n + path.length, 0), each = Math.ceil(corners / MOST_ASKED) || 1;
    return [...some, ...rings.flatMap((path) => path.filter((_, k) => k % each === 0))];
  }

  open() {
    this.deck = new PacedDeck({
      parent: this.canvasPlace,
      animationFrameProvider: this.pace,
      views: new MapView({ id: "map", repeat: false }),
      controller: { keyboard: false, doubleClickZoom: true },
      initialViewState: { ...this.fit(), maxZoom: 24 },
      layers: [],
      pickingRadius: 0,
      _pickable: false,
      getCursor: ({ isDragging }) => (isDragging ? "grabbing" : this.drawing.mode ? "crosshair" : "grab"),
      onViewStateChange: ({ viewState, interactionState }) => this.limited(viewState, interactionState),
      onAfterRender: () => {
        this.pace.wake();
        if (this.drive.isStale(this.viewport()) || this.dots.isStale(this.jsons, this.viewport())) this.drawLayers();
        this.follow();
        for (const done of this.waiting.splice(0)) done();
      },
      onLoad: () => {
        const canvas = this.canvasPlace.querySelector("canvas");
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", this.data.alt);
        canvas.tabIndex = -1; // keys are the map's own: see keys.js
      },
    });
    this.watch = new ResizeObserver(() => { this.pace.wake(); this.resized(); });
    this.watch.observe(this.canvasPlace);
  }

  limited(view, interaction) {
    // a robot is seen from aside, and let go of by who moves the map
    this.drive.release(interaction);
    // tilting is of no use on a plan, and turning it loses north
    return this.data.drive ? view : { ...view, pitch: 0 };
  }

  // a window or a panel that changes its size before anybody moved the map shows the whole plot again, but
  // not under the finger of who sets corners
  resized() {
    this.boxes = null;
    if (this.drive.leads()) this.drawLayers(); // who follows a robot stays near it
    else if (this.deck && !this.moved && !(this.drawing.outlines && this.drawing.points.length)) this.deck.setProps({ initialViewState: { ...this.fit(), maxZoom: 24 } });
  }

  // -- drawing

  drawLayers() {
    if (!this.deck) return;
    this.boxes = null;
    const accent = this.data.dark || this.data.ground?.picture ? [255, 220, 90] : [0, 110, 70];
    const followed = this.viewport() && this.drive.view(this.viewport(), this.middle());
    if (followed) this.deck.setProps({ initialViewState: { ...followed, maxZoom: 24 } });
    const jsons = [...this.drive.of(this.dots.drawn(this.frames.of(this.jsons), this.viewport())), ...this.playback.layers(this.data.dark), ...this.drawing.layers(accent)];
    const hidden = new Set(this.off().flatMap((name) => this.switchOf(name)?.layers ?? []));
    for (const name of this.data.shades?.flatMap((one) => (one.key === this.shade() ? [] : one.layers)) ?? []) hidden.add(name);
    const ground = { ...this.data.ground, opacity: this.groundOpacity, failed: () => this.groundFailed() };
    const driven = this.drive.layers(this.viewport(), this.data.dark);
    this.deck.setProps({ layers: [...layersOf(jsons, hidden, this.opacity, ground), ...driven] });
    this.drawBar();
    this.follow();
  }

  follow() {
    const viewport = this.viewport();
    if (!viewport) return;
    this.scale.draw(viewport, { lengths: this.data.lengths, alt: this.data.words.scale });
    const labels = this.drawing.outlines ? this.drawing.labels() : this.dots.labels(withHot(this.data.labels ?? NONE, this.frames.of(this.jsons)), this.jsons, viewport);
    this.labels.draw(labels, viewport, new Set(this.off()), ...this.around(), this.drive.labels());
    if (!this.cross.hidden) this.pointAtMiddle();
    const { longitude, latitude, zoom, bearing, width, height } = viewport;
    this.root.dataset.view = JSON.stringify({ longitude, latitude, zoom, bearing, width, height });
  }

  viewport() {
    return this.deck?.isInitialized ? this.deck.getViewports()[0] : null;
  }

  // Return the layers as they are now: of the day that is shown, and with the dots of this zoom.
  now() {
    return this.dots.of(this.frames.of(this.jsons), this.viewport());
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
      this.groundOpacity = kept.ground ?? 1;
      this.shaded = kept.shade;
    } catch {
      this.touched = new Set();
    }
  }

  keep() {
    const kept = { touched: [...this.touched], hidden: [...this.hidden], opacity: this.opacity, ground: this.groundOpacity, shade: this.shaded };
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
    const now = JSON.stringify([words, switches, shades, legend, this.data.select, this.data.ground?.ids, this.data.draw?.kind]);
    if (now === this.furnished) return;
    this.furnished = now;
    this.tools.replaceChildren(
      button("plus", words.zoom_in, () => this.zoom(1)),
      button("minus", words.zoom_out, () => this.zoom(-1)),
      button("fit", words.whole_plot, () => this.whole()),
      ...(this.data.draw?.kind === "outline" ? [button("here", words.here, () => this.goHere())] : []),
      button("layers", words.layers, () => this.openCard(), { "aria-expanded": String(!this.card.hidden), class: "tool layers" }),
      ...(this.data.select ? [
        button("lasso", words.select, () => this.selecting("lasso")),
        button("rows", words.select_rows, () => this.selecting("rows"))] : []),
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
    if (this.data.ground?.ids.length) {
      const ground = element("input", { type: "range", min: 0.1, max: 1, step: 0.05, value: this.groundOpacity,
        "aria-label": words.ground, oninput: () => { this.groundOpacity = Number(ground.value); this.keep(); this.drawLayers(); } });
      parts.push(element("label", { class: "wide" }, [element("span", { text: words.ground }), ground]));
    }
    return parts;
  }

  openCard() {
    this.card.hidden = !this.card.hidden;
    this.tools.querySelector(".layers").setAttribute("aria-expanded", String(!this.card.hidden));
    if (!this.card.hidden) this.card.querySelector("input")?.focus();
  }

  legendShown() {
    // the ground is not covered by a plan, so a plan needs no signs there
    const off = new Set([...this.off(), ...(this.data.ground?.ids.length && !this.hidden.has("ground") ? ["plan"] : [])]);
    return (this.data.legend ?? []).filter(({ of }) =>
      !of || of === `shade:${this.shade()}` || (this.switchOf(of) && !off.has(of)));
  }

  showLegend() {
    const shown = this.legendShown();
    for (const [kind, colour] of (this.data.legend ?? []).flatMap((one) => one.items)) {
      const name = `${kind} ${colour}`; // loaded ahead, for pictures
      if (!this.signs.has(name)) this.signs.set(name, signPicture(kind, colour));
    }
    // on a phone there is room for the first part only, until more is asked for
    const more = shown.length > 1 ? [button("more", this.data.words.legend, () => this.wholeLegend(), { class: "tool more" })] : [];
    this.legend.replaceChildren(...legendOf(shown), ...more);
    this.tellLegend();
    this.legend.hidden = !shown.length;
  }

  // Show the whole legend of a phone, or its first part only.
  wholeLegend() {
    this.legend.classList.toggle("whole");
    this.tellLegend();
    this.boxes = null;
    this.drawLayers();
  }

  tellLegend() {
    this.legend.querySelector(".more")?.setAttribute("aria-expanded", this.legend.classList.contains("whole"));
  }

  zoom(by) {
    const view = this.viewport();
    if (!view) return;
    this.moved = true;
    const { longitude, latitude, zoom, bearing, pitch } = view;
    this.deck.setProps({ initialViewState: { longitude, latitude, bearing, pitch, maxZoom: 24,
      zoom: Math.min(24, zoom + by), transitionDuration: 200 } });
  }

  whole() {
    this.moved = false;
    this.drive.release({ isPanning: true });
    // deck.gl goes nowhere for a view that equals the one last wished for, wherever the wheel went since
    this.odd = !this.odd;
    this.deck?.setProps({ initialViewState: { ...this.fit(), maxZoom: 24, transitionDuration: this.odd ? 300 : 301 } });
  }

  showGround({ ground, words }) {
    const shown = ground?.ids.length > 0;
    this.root.classList.toggle("over-picture", Boolean(shown && ground.picture));
    const key = JSON.stringify(ground?.ids);
    if (this.groundKey !== key) this.groundAway = false;
    this.groundKey = key;
    this.credit.hidden = !shown || !(ground.credit || this.groundAway);
    this.credit.textContent = this.groundAway ? words.ground_away : ground?.credit ?? "";
  }

  groundFailed() {
    if (this.groundAway) return;
    this.groundAway = true;
    this.showGround(this.data);
  }

  // -- the map as a picture

  shoot() {
    if (!this.deck) return;
    this.shot(this.frames.day ?? this.data.when, 4000).toBlob((blob) => saved(blob, this.data.words.picture_name));
  }

  // Wait until what was set last is drawn; a page that nobody sees is not drawn, and not waited for.
  rendered() {
    return new Promise((done) => { this.waiting.push(done); setTimeout(done, 1500); });
  }

  // Return what is on the map now as a canvas; `said` follows the plot's name in its title.
  shot(said, most) {
    this.deck.redraw("picture");
    this.follow();
    const size = this.size(), part = freePart(size, covered()), style = getComputedStyle(this.root);
    const colour = (name, other) => style.getPropertyValue(name).trim() || other;
    return composed({
      canvas: this.canvasPlace.querySelector("canvas"), size, part, most,
      colours: { ground: colour("--ground", "#e9ece4"), surface: colour("--surface", "#fff"), ink: colour("--ink", "#1b2a22"),
        route: colour("--route", "#0c3eaa"), onRoute: this.data.dark ? "#06202c" : "#fff" },
      title: [this.data.title, said].filter(Boolean).map((one) => `\u2068${one}\u2069`).join(" · "), credit: this.credit.hidden ? "" : this.credit.textContent,
      legend: this.legendShown(), signs: (kind, c) => this.signs.get(`${kind} ${c}`), bar: this.scale.length,
      labels: this.labels.placed, onPicture: this.root.classList.contains("over-picture"), rtl: this.data.direction === "rtl",
    });
  }

  // -- drawing and selecting

  selecting(kind) {
    const on = this.drawing.mode?.kind === kind;
    this.drawing.begin(on ? (this.data.draw ?? null) : { kind, id: kind });
    this.drawBar();
  }

  drawn(mode, points) {
    if (mode.kind !== "lasso") {
      this.tell("drawn", { kind: mode.id, points });
      return;
    }
    const places = this.places();
    this.drawing.begin(this.data.draw ?? null);
    if (!places) return;
    const own = plantsWithin(places, points);
    this.pick(this.adding ? new Set([...this.picked, ...own]) : new Set(own));
  }

  // -- where one stands

  // Return where the browser says that one is: {at: [lon, lat], off (m)}; null, and a word, where it does not.
  async standing() {
    this.tip.hidden = true; // what was said of another place
    const asked = new Promise((done, failed) => {
      navigator.geolocation.getCurrentPosition(done, failed, { enableHighAccuracy: true, timeout: WAIT_MS, maximumAge: 0 });
    });
    try {
      const { coords } = await asked;
      return { at: [coords.longitude, coords.latitude], off: coords.accuracy };
    } catch {
      this.say(this.data.words.nowhere);
      return null;
    }
  }

  async goHere() {
    const here = await this.standing();
    if (here) this.tell("drawn", { kind: `${this.data.draw?.id} here`, points: [here.at] });
  }

  // Set a corner where one stands, if that is known well enough; it is in view then.
  async cornerHere() {
    const here = await this.standing(), { words } = this.data;
    if (!here || !this.drawing.outlines) return;
    const off = Math.ceil(here.off).toLocaleString(this.data.language);
    if (here.off > CORNER_M) {
      this.say(words.rough.replace("{off}", off).replace("{most}", CORNER_M));
      return;
    }
    this.drawing.add(here.at);
    this.say(words.standing.replace("{off}", off));
    this.showCorners();
  }

  // Show all corners where the last one is out of view, or seen from too far.
  showCorners() {
    const view = this.viewport(), part = freePart(this.size(), covered()), { points } = this.drawing;
    const [x, y] = view.project(points.at(-1));
    const inView = x > part.x && y > part.y && x < part.x + part.width && y < part.y + part.height;
    if (inView && metresPerPixel(view) <= CORNER_M_A_PX) return;
    const [lon, lat] = [0, 1].map((k) => points.map((p) => p[k]));
    const bounds = [Math.min(...lon), Math.min(...lat), Math.max(...lon), Math.max(...lat)];
    const all = fitted(bounds, this.size(), this.padding());
    this.moved = true;
    this.deck.setProps({ initialViewState: { ...all, zoom: Math.min(all.zoom, NEAR_ZOOM), maxZoom: 24 } });
  }

  places() {
    return this.jsons.find((one) => one.places)?.places;
  }

  // Let these plants be the ones that are selected.
  pick(plants) {
    if (plants.size > MOST_PICKED) {
      this.say(this.data.words.too_many.replace("{most}", MOST_PICKED.toLocaleString(this.data.language)));
      return;
    }
    this.picked = plants;
    this.tell("selected", { runs: runsOf(plants) });
  }

  pickRow(row) {
    const places = this.places();
    if (places && this.data.select) this.pick(withRow(places, this.picked, row));
  }

  // Say something for a moment, on the map and to who hears it.
  say(text) {
    this.heard.textContent = text;
    this.tip.textContent = text;
    this.tip.hidden = false;
    const [x, y] = this.middle();
    this.tip.style.transform = `translate(${x - this.tip.offsetWidth / 2}px, ${y}px)`;
  }

  drawBar() {
    const { mode, points, ready } = this.drawing;
    this.root.classList.toggle("drawing", Boolean(mode));
    const outlines = mode?.kind === "outline", said = outlines ? this.data.draw?.hint : null;
    const now = JSON.stringify([mode?.id, points.length, ready, this.drawing.canUndo, said, this.data.words]);
    if (now === this.barred) return;
    this.barred = now;
    this.bar.hidden = !mode;
    if (!mode) return;
    const { words } = this.data;
    const press = (label, act, more = {}) => element("button", { type: "button", text: label, onclick: act, ...more });
    const hint = { lasso: words.lasso_hint, rows: words.rows_hint }[mode.kind] ?? mode.hint ?? words.draw_hint;
    this.bar.replaceChildren(
      element("span", { text: said ? said : points.length && mode.kind !== "bent" ? words.corners.replace("{n}", points.length) : hint }),
      ...(mode.kind === "rows" ? [press(words.draw_done, () => this.selecting("rows"), { class: "main" })] : [
        press(words.draw_back, () => this.drawing.undo(), { disabled: !this.drawing.canUndo }),
        press(words.draw_drop, () => { this.drawing.drop(); if (mode.kind === "lasso") this.selecting("lasso"); })]),
      ...(outlines ? [press(words.corner_here, () => this.cornerHere())] : []),
      ...(["point", "lasso", "rows", "bent"].includes(mode.kind) ? [] : [press(words.draw_done, () => this.drawing.finish(), { disabled: !ready, class: "main" })]),
    );
  }

  // -- the pointer

  listen() {
    const place = this.canvasPlace;
    // at dusk many devices turn dark by themselves: what the server colours follows, once Streamlit knows
    this.turned = () => setTimeout(() => this.tell?.("turned", this.turn), TURN_MS);
    DARK.addEventListener("change", this.turned);
    for (const kind of HANDS) place.addEventListener(kind, () => this.pace.wake(), { passive: true, capture: true });
    place.setAttribute("role", "application");
    place.tabIndex = 0;
    place.addEventListener("pointerdown", (event) => this.pressed(event), true);
    place.addEventListener("pointermove", (event) => this.hovered(event), true);
    place.addEventListener("pointerup", (event) => this.released(event), true);
    place.addEventListener("pointerleave", () => { this.tip.hidden = true; });
    place.addEventListener("wheel", () => { this.moved = true; this.tip.hidden = this.choice.hidden = true; }, { passive: true, capture: true });
    place.addEventListener("keydown", (event) => this.typed(event));
    place.addEventListener("focus", () => { if (place.matches(":focus-visible")) this.showCross(); });
    place.addEventListener("blur", () => { this.cross.hidden = true; this.tip.hidden = true; });
    // what lies on the map is left by Escape, back to the map
    this.root.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && !place.contains(event.target)) this.leave();
    });
    this.labelPlace.addEventListener("click", ({ target }) => { if (target.dataset.row) this.pickRow(Number(target.dataset.row)); });
  }

  // -- the keyboard

  typed(event) {
    if (event.key === " " && this.drive.data) {
      this.drive.pressed(event);
      return;
    }
    const wanted = asked(event, this.drawing.mode?.kind ?? null), viewport = this.viewport();
    if (!wanted || !viewport) return;
    event.preventDefault();
    event.stopPropagation();
    if (wanted.leave) this.leave();
    else this.showCross();
    if (wanted.move) {
      this.drive.release({ isPanning: true });
      this.moved = true;
      this.deck.setProps({ initialViewState: { ...moved(viewport, wanted.move), maxZoom: 24 } });
    }
    if (wanted.zoom) this.zoom(wanted.zoom);
    if (wanted.whole) this.whole();
    if (wanted.back) this.drawing.undo();
    if (wanted.finish) this.drawing.finish();
    if (wanted.press) this.tapped(viewport.unproject(this.middle()));
  }

  leave() {
    this.tip.hidden = true;
    const chosen = !this.choice.hidden;
    this.choice.hidden = true;
    // corners of a plot may have been walked to: they are dropped by their button only
    if (chosen) this.showCross();
    else if (this.drawing.mode && this.drawing.points.length && !this.drawing.outlines) this.drawing.drop();
    else if (["lasso", "rows"].includes(this.drawing.mode?.kind)) this.selecting(this.drawing.mode.kind);
    else if (!this.card.hidden) this.openCard();
    else this.cross.hidden = true;
    this.canvasPlace.focus({ preventScroll: true });
  }

  // Return the middle of what panels leave free, where the cross is.
  middle() {
    const { x, y, width, height } = freePart(this.size(), covered());
    return [x + width / 2, y + height / 2];
  }

  showCross() {
    const [x, y] = this.middle();
    this.cross.style.transform = `translate(${x}px, ${y}px)`;
    this.cross.hidden = false;
    this.pointAtMiddle();
  }

  pointAtMiddle() {
    const [x, y] = this.middle(), here = this.viewport()?.unproject([x, y]);
    if (!here) return;
    const box = this.root.getBoundingClientRect();
    this.point({ clientX: box.left + x, clientY: box.top + y }, here);
    this.heard.textContent = this.tip.hidden ? "" : this.tip.textContent;
  }

  at(event) {
    const box = this.canvasPlace.getBoundingClientRect();
    return this.viewport()?.unproject([event.clientX - box.left, event.clientY - box.top]);
  }

  pressed(event) {
    this.tip.hidden = true;
    this.choice.hidden = true;
    this.down = event;
    const here = this.at(event);
    if (!here || !this.drawing.mode || event.button) return;
    this.adding = event.shiftKey;
    if (this.drawing.mode.kind === "lasso") {
      this.drawing.drop();
      this.trailing = true;
    } else if (this.drawing.mode.kind !== "rows") {
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
    const near = (one) => Math.hypot(event.clientX - one.clientX, event.clientY - one.clientY);
    const here = this.at(event);
    // a corner that is pressed and not moved is tapped
    if (held >= 0 && !(this.drawing.outlines && held === 0 && from && near(from) <= STILL_PX)) {
      this.drawing.dropped(held, this.viewport());
      return;
    }
    if (!here || !from || event.button || near(from) > STILL_PX) return;
    this.last = event;
    this.cross.hidden = true;
    // the second half of a double click, which zooms
    if (before && event.timeStamp - before.timeStamp < TWICE_MS && near(before) < STILL_PX) return;
    if (!this.drawing.mode) this.point(event, here);
    this.tapped(here);
  }

  // Do what a tap on a place does: draw a corner, take a row, or tell the server what lies there.
  tapped(here) {
    if (this.drawing.mode?.kind === "rows") {
      const hit = this.under(here, (json) => json.places);
      if (hit) this.pickRow(hit.row);
      return;
    }
    if (this.drawing.outlines && metresPerPixel(this.viewport()) > CORNER_M_A_PX) {
      this.say(this.data.words.closer);
      return;
    }
    if (this.drawing.mode) {
      this.drawing.click(here, this.viewport());
      return;
    }
    const hit = this.under(here);
    if (!hit || !this.data.taps) return;
    if (hit.several) this.choose(hit.several, this.viewport().project(here));
    else this.tell("tapped", { layer: hit.id, index: hit.index });
  }

  // Ask which of several plots under a place is meant.
  choose(several, [x, y]) {
    const all = this.jsons.find(({ id }) => id === MARKS).data, said = this.data.words.plots_here.replace("{n}", several.length);
    this.tip.hidden = true;
    this.choice.setAttribute("aria-label", said);
    this.choice.replaceChildren(element("div", { class: "title", text: said }), ...several.map((index) =>
      element("button", { type: "button", text: all[index].t, onclick: () => {
        this.choice.hidden = true;
        this.tell("tapped", { layer: MARKS, index });
      } })));
    this.choice.hidden = false;
    const part = freePart(this.size(), covered()), { offsetWidth: wide, offsetHeight: tall } = this.choice;
    const within = (at, low, high) => Math.max(low + MARGIN_PX, Math.min(at, high - MARGIN_PX));
    const [left, top] = [within(x + TIP_PX, part.x, part.x + part.width - wide), within(y + TIP_PX, part.y, part.y + part.height - tall)];
    this.choice.style.transform = `translate(${left}px, ${top}px)`;
    this.choice.querySelector("button").focus({ preventScroll: true });
  }

  // Return what is pointed at where several plots are.
  saidOf(several, all) {
    const said = several.slice(0, MOST_SAID).map((k) => all[k].t), more = several.length > MOST_SAID ? ["…"] : [];
    return [this.data.words.plots_here.replace("{n}", several.length), ...said, ...more].join("\n");
  }

  // Return what lies under a place: {id, index, text}, the topmost first, and `several` plots if there
  // are; null for the ground.
  under(here, of = () => true) {
    const reachM = TIP_PX * metresPerPixel(this.viewport());
    const shown = new Set(this.deck.props.layers.filter((layer) => layer.props.visible).map((layer) => layer.id));
    const jsons = this.now(), all = this.jsons.find(({ id }) => id === MARKS)?.data;
    for (const json of jsons.toReversed()) {
      if (!shown.has(json.id) || !of(json)) continue;
      if (json.places) {
        const k = nearestPlant(json.places, here, Math.max(json.radius, Math.min(reachM, 0.6 * json.apart)));
        if (k >= 0) return { id: json.id, index: k, text: tipOf(json, k), row: json.places.row[k] };
      } else if (json.id === MARKS) {
        const dot = dotUnder(json.data, here, this.viewport(), TIP_PX);
        if (dot?.of.length === 1) return { id: json.id, index: dot.of[0], text: dot.t };
        if (dot) return { several: dot.of, text: this.saidOf(dot.of, all) };
      } else if (Array.isArray(json.data)) {
        const [k, ...below] = rowsUnder(json.data, here, reachM);
        const plots = all && below.length ? [...new Set([k, ...below].map((one) => json.data[one].n))] : [];
        if (plots.length > 1) return { several: plots.sort((a, b) => a - b), text: this.saidOf(plots, all) };
        if (k !== undefined) return { id: json.id, index: k, text: json.data[k].t };
      }
    }
    return null;
  }

  point(event, here) {
    const rows = this.drawing.mode?.kind === "rows";
    const hit = this.deck && (rows || !this.drawing.mode) ? this.under(here, rows ? (json) => json.places : undefined) : null;
    this.tip.hidden = !hit?.text;
    if (this.tip.hidden) return;
    const box = this.root.getBoundingClientRect();
    this.tip.textContent = hit.text;
    const x = Math.min(event.clientX - box.left + 14, box.width - this.tip.offsetWidth - 8);
    const y = Math.min(event.clientY - box.top + 14, box.height - this.tip.offsetHeight - 8);
    this.tip.style.transform = `translate(${Math.max(8, x)}px, ${Math.max(8, y)}px)`;
  }

  end() {
    this.turn++; // what is still being fetched is no longer wanted
    this.playback.stop();
    this.frames.show(null);
    this.drive.end();
    this.watch?.disconnect();
    DARK.removeEventListener("change", this.turned);
    this.shape.end();
    this.deck?.finalize();
    this.root.remove();
  }
}

function saved(blob, name) {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const UTF8 = new TextDecoder();

export function mount(component) {
  const { parentElement } = component;
  parentElement.mapPage ??= new MapPage(parentElement);
  parentElement.mapPage.show({ ...component, data: JSON.parse(UTF8.decode(component.data)) });
  return () => {
    parentElement.mapPage?.end();
    parentElement.mapPage = null;
  };
}
