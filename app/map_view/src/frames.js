// The season's days on the map: a slider, a film that plays them, and the film as a file.

import { element } from "./chrome.js";
import * as film from "./film.js";
import * as store from "./store.js";

export class Frames {
  // `changed` is called when another day is to be drawn; `shot` returns the map as a canvas, with a title;
  // `save` takes a file's bytes and name, `called` says what is shown; `gone` is called when the server has let go of a day
  constructor(place, { changed, shot, save, gone, called = () => "" }) {
    Object.assign(this, { changed, shot, save, gone, called });
    this.root = place.appendChild(element("div", { class: "play", hidden: true }));
    this.data = null;
    this.made = null;
  }

  // `data` is {key, names: [...], layers: [[where, ...], ...], now} or null
  show(data, words) {
    if (data?.key === this.data?.key) {
      this.data = data; // a server that was started anew has the same days elsewhere
      return;
    }
    this.stop();
    this.data = data;
    this.made = null;
    this.root.hidden = !data;
    if (!data) return;
    this.ids = new Set(data.layers.flat().map((where) => where.id));
    const last = data.names.length - 1;
    this.press = element("button", { type: "button", class: "tool", text: "▶", "aria-label": words.play_season, onclick: () => this.toggle() });
    this.slider = element("input", { type: "range", min: 0, max: last, step: 1, value: data.now, "aria-label": words.day,
      oninput: () => { this.stop(); this.to(Number(this.slider.value)); } });
    this.slider.value = data.now;
    this.name = element("span", { class: "clock" });
    this.films = film.kinds().map((kind) => element("button", { type: "button", class: "tool film", text: kind.toUpperCase(),
      title: words.film, "aria-label": `${kind.toUpperCase()} ${words.film}`, onclick: () => this.record(kind, words) }));
    this.root.replaceChildren(this.press, this.slider, this.name, ...this.films);
    this.tell(data.now);
  }

  tell(k) {
    this.slider.setAttribute("aria-valuetext", this.data.names[k]);
    this.name.textContent = this.data.names[k];
  }

  // Show a day once it is fetched, and name it only then; return whether it is still the one that is wanted.
  async to(k) {
    const { key } = this.data;
    this.wanted = k;
    this.slider.value = k;
    const made = await store.persist(
      () => Promise.all(this.data.layers[k].map(store.layer)),
      () => this.wanted === k && this.data?.key === key,
      this.gone,
    );
    if (!made) return false;
    this.tell(k);
    this.made = k === this.data.now ? null : made;
    this.changed();
    return true;
  }

  // Return the map's layers with the day's own in the place of those that belong to days.
  of(jsons) {
    if (!this.made) return jsons;
    const first = Math.max(0, jsons.findIndex((json) => this.ids.has(json.id)));
    const others = jsons.map((json, k) => [json, k]).filter(([json]) => !this.ids.has(json.id));
    const part = (below) => others.filter(([, k]) => (k < first) === below).map(([json]) => json);
    return [...part(true), ...this.made, ...part(false)];
  }

  // Return which switches are off meanwhile: the route is today's.
  get hides() {
    return this.made || this.filming ? ["route", "numbers"] : [];
  }

  // Return the name of the day that is shown, where there are days.
  get day() {
    return this.data ? this.name.textContent : null;
  }

  toggle() {
    if (this.run) this.stop();
    else this.play();
  }

  async play() {
    const run = (this.run = {}), { length } = this.data.names;
    this.press.textContent = "❚❚";
    let k = Number(this.slider.value);
    if (k >= length - 1) k = 0;
    for (; k < length && this.run === run; k++) {
      await this.to(k);
      await new Promise((done) => setTimeout(done, film.EACH_MS));
    }
    if (this.run === run) this.stop();
  }

  stop() {
    this.run = null;
    if (this.press) this.press.textContent = "▶";
  }

  // Save the season as a film, from its first day to its last: the map with its legend, a day a picture.
  async record(kind, words) {
    if (this.filming) return;
    this.stop();
    const day = Number(this.slider.value), { key } = this.data, tools = [this.press, this.slider, ...this.films];
    const same = () => this.data?.key === key;
    this.filming = true;
    for (const one of tools) one.disabled = true;
    try {
      const made = kind === "gif" ? await film.gif(this.pictures()) : await film.webm(this.canvases());
      if (made && same()) this.save(kind === "gif" ? new Blob([made], { type: "image/gif" }) : made, `${fileName(this.called()) || words.film_name}.${kind}`);
    } finally {
      this.filming = false;
      for (const one of tools) one.disabled = false;
      if (same()) await this.to(day);
    }
  }

  async *canvases() {
    const { key, names } = this.data;
    for (let k = 0; k < names.length; k++) {
      if (this.data?.key !== key || !(await this.to(k))) return;
      // a breath, so that the page is not frozen while it films
      await new Promise((done) => setTimeout(done));
      yield await this.shot(names[k]);
    }
  }

  async *pictures() {
    for await (const canvas of this.canvases()) {
      const { width, height } = canvas;
      yield { width, height, data: canvas.getContext("2d").getImageData(0, 0, width, height).data };
    }
  }
}

// Return what something is called in letters that a file's name may have anywhere.
function fileName(name) {
  return name.replace(/[\u2066-\u2069]/g, "").replace(/[\\/:*?"<>|\u0000-\u001f]/g, "_").trim();
}
