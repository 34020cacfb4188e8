// When things are sent: after each tap, when a network comes, and again and again until all is there.

import { Held, KeyEnded } from "./sync.js";

// after a tap the page is left to the finger first
const AFTER_TAP_MS = 1000, SOON_MS = 3000, LATEST_MS = 60000, NEWS_MS = 60000;

export class Runner {
  constructor(sync, field, tell) {
    Object.assign(this, { sync, field, tell, wait: SOON_MS, state: "idle", news: 0 });
    addEventListener("online", () => this.now());
    addEventListener("offline", () => { if (!this.running) this.#say("offline"); });
    document.addEventListener("visibilitychange", () => { if (!document.hidden) this.now(); });
  }

  now() { this.wait = SOON_MS; this.#later(0); }

  afterTap() { this.wait = SOON_MS; this.#later(AFTER_TAP_MS); }

  #later(ms) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.#run(), ms);
  }

  /** The next time, unless a tap asked for one meanwhile. */
  #next(ms) { if (!this.timer) this.#later(ms); }

  async #run() {
    this.timer = null;
    if (this.running) { this.again = true; return; }
    this.running = true;
    const alone = navigator.locks ? (work) => navigator.locks.request("fieldmon sync", work) : (work) => work();
    try {
      this.#say("sending");
      await alone(() => this.sync.send());
      await this.#news();
      this.#say("sent");
      this.wait = SOON_MS;
      this.#next(NEWS_MS);
    } catch (error) {
      this.#say(error instanceof KeyEnded ? "ended" : error instanceof Held ? "held" : "offline");
      this.#next(this.wait);
      this.wait = Math.min(this.wait * 2, LATEST_MS);
    }
    this.running = false;
    if (this.again) { this.again = false; this.#later(0); }
  }

  async #news() {
    await this.field.reread();
    // a code was scanned without a network
    if (this.field.access && !this.field.day) return this.field.load();
    // what was found or taken back here is asked for at once; a clock that was set back must not put it off
    if (!this.field.changedHere?.() && Math.abs(Date.now() - this.news) < NEWS_MS) return;
    this.news = Date.now();
    await this.field.refresh();
  }

  #say(state) { this.state = state; this.tell(state, this.sync.stranded); }
}
