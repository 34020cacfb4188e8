// The day's work, played on the map: the way driven so far, the stops made, and who drives.

import { element } from "./chrome.js";
import { sinceLast } from "./frame_time.js";

const SECONDS = 20; // a whole day, played

export class Playback {
  constructor(place, changed) {
    this.changed = changed;
    this.root = place.appendChild(element("div", { class: "play", hidden: true }));
    this.plan = null;
  }

  // `plan` is {line: [[lon, lat], ...], at_s, stops: [[lon, lat], ...], leave_s, starts_s, key} or null
  show(plan, words) {
    if (plan?.key === this.plan?.key) return;
    this.stop();
    this.plan = plan;
    this.second = null;
    this.root.hidden = !plan;
    if (!plan) return;
    const end = plan.at_s.at(-1);
    this.press = element("button", { type: "button", class: "tool", text: "▶", "aria-label": words.play, onclick: () => this.toggle() });
    this.slider = element("input", { type: "range", min: 0, max: end, step: 1, value: 0, "aria-label": words.time_of_day,
      oninput: () => { this.stop(); this.to(Number(this.slider.value)); } });
    this.clock = element("span", { class: "clock" });
    this.root.replaceChildren(this.press, this.slider, this.clock);
    this.tell(0);
  }

  toggle() {
    if (this.timer) {
      this.stop();
      return;
    }
    const end = this.plan.at_s.at(-1);
    const since = sinceLast();
    let from = this.second === null || this.second >= end ? 0 : this.second;
    this.press.textContent = "❚❚";
    const step = (now) => {
      from += (since(now) / 1000) * (end / SECONDS);
      this.to(Math.min(from, end));
      if (from >= end) this.stop();
      else this.timer = requestAnimationFrame(step);
    };
    this.timer = requestAnimationFrame(step);
  }

  stop() {
    if (this.timer) cancelAnimationFrame(this.timer);
    this.timer = null;
    if (this.press) this.press.textContent = "▶";
  }

  to(second) {
    this.second = second;
    this.slider.value = second;
    this.tell(second);
    this.changed();
  }

  tell(second) {
    const minutes = Math.floor((this.plan.starts_s + second) / 60);
    this.clock.textContent = `${String(Math.floor(minutes / 60) % 24).padStart(2, "0")}:${String(minutes % 60).padStart(2, "0")}`;
  }

  // Return the layers of the moment, in pydeck's JSON; none before anything was played.
  layers(dark) {
    if (!this.plan || this.second === null) return [];
    const { line, at_s, stops, leave_s } = this.plan, second = this.second;
    let gone = at_s.findIndex((s) => s > second);
    if (gone < 0) gone = at_s.length;
    const here = between(line, at_s, gone, second);
    const colour = dark ? [110, 220, 255] : [12, 62, 170];
    const made = stops.filter((_, k) => leave_s[k] <= second);
    return [
      { "@@type": "PathLayer", id: "trail", data: [{ q: [...line.slice(0, gone), here] }], getPath: "@@=q",
        getColor: [...colour, 230], getWidth: 5, widthUnits: "pixels", capRounded: true, jointRounded: true },
      { "@@type": "ScatterplotLayer", id: "stops-made", data: made.map((q) => ({ q })), getPosition: "@@=q",
        getFillColor: [...colour, 170], getRadius: 0.5, radiusMinPixels: 2.5 },
      { "@@type": "ScatterplotLayer", id: "robot", data: [{ q: here }], getPosition: "@@=q", getFillColor: [255, 210, 0],
        getLineColor: [0, 0, 0], stroked: true, getRadius: 9, radiusUnits: "pixels", getLineWidth: 3, lineWidthUnits: "pixels" },
    ];
  }
}

function between(line, at_s, gone, second) {
  if (gone >= line.length) return line.at(-1);
  const [a, b] = [line[gone - 1], line[gone]], span = at_s[gone] - at_s[gone - 1];
  const share = span > 0 ? (second - at_s[gone - 1]) / span : 1;
  return [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
}
