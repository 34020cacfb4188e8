// The season's days on the map: a slider, a film that plays them, and the film as a file.

import { element } from "./chrome.js";
import * as store from "./store.js";

const EACH_MS = 700;

export class Frames {
  // `changed` is called when another day is to be drawn; `canvas` returns the map's canvas
  constructor(place, changed, canvas) {
    this.changed = changed;
    this.canvas = canvas;
    this.root = place.appendChild(element("div", { class: "play", hidden: true }));
    this.data = null;
    this.made = null;
  }

  // `data` is {key, names: [...], layers: [[where, ...], ...], now} or null
  show(data, words) {
    if (data?.key === this.data?.key) return;
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
    this.name = element("span", { class: "clock" });
    const film = element("button", { type: "button", class: "tool film", text: "⏺", title: words.film, "aria-label": words.film,
      onclick: () => this.record(words.film_name) });
    this.root.replaceChildren(this.press, this.slider, this.name, ...(window.MediaRecorder ? [film] : []));
    this.tell(data.now);
  }

  tell(k) {
    this.slider.value = k;
    this.name.textContent = this.data.names[k];
  }

  async to(k) {
    this.wanted = k;
    this.tell(k);
    const made = await Promise.all(this.data.layers[k].map(store.layer)).catch(() => null);
    if (!made || this.wanted !== k) return;
    this.made = k === this.data.now ? null : made;
    this.changed();
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
    return this.made ? ["route", "numbers"] : [];
  }

  toggle() {
    if (this.timer) this.stop();
    else this.play();
  }

  async play(ended) {
    const last = this.data.names.length - 1;
    this.press.textContent = "❚❚";
    let k = Number(this.slider.value) >= last ? 0 : Number(this.slider.value);
    await this.to(k);
    const step = async () => {
      if (k >= last) {
        this.stop();
        ended?.();
        return;
      }
      await this.to(++k);
      if (this.timer) this.timer = setTimeout(step, EACH_MS);
    };
    this.timer = setTimeout(step, EACH_MS);
  }

  stop() {
    if (this.timer) clearTimeout(this.timer);
    this.timer = null;
    if (this.press) this.press.textContent = "▶";
  }

  // Save the season as a film: the map's picture, and the day in its corner.
  async record(name) {
    this.stop();
    const map = this.canvas(), picture = element("canvas");
    picture.width = map.width;
    picture.height = map.height;
    const pen = picture.getContext("2d");
    this.added = () => {
      pen.fillStyle = getComputedStyle(map.closest(".map")).backgroundColor;
      pen.fillRect(0, 0, picture.width, picture.height);
      pen.drawImage(map, 0, 0);
      pen.font = "600 28px system-ui, sans-serif";
      pen.fillStyle = getComputedStyle(map.closest(".map")).color;
      pen.fillText(this.name.textContent, 24, picture.height - 28);
    };
    const recorder = new MediaRecorder(picture.captureStream(10), { mimeType: "video/webm" });
    const parts = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      const link = element("a", { href: URL.createObjectURL(new Blob(parts, { type: "video/webm" })), download: name });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
      this.added = null;
    };
    this.slider.value = this.data.names.length - 1; // from the first day
    recorder.start();
    await this.play(() => setTimeout(() => recorder.stop(), EACH_MS));
  }

  // Take what was just drawn into the film that is being made, if one is.
  drawn() {
    this.added?.();
  }
}
