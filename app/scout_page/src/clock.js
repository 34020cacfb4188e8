// What is known of the phone's clock: it may be wrong after the battery was empty, and be set at any time.
// The season's time, last heard, is the least that it can be; what has passed since runs on where the page stays open.

const WRONG_MS = 120000;

export class Clock {
  /** `now` is the phone's clock, `tick` counts milliseconds since the page was opened. */
  constructor(now = () => new Date(), tick = () => performance.now()) { Object.assign(this, { now, tick, heard: null, heardAt: null, fast: 0 }); }

  /** What was known when the page was closed. */
  knew(heard) {
    if (!heard || heard <= (this.least() ?? 0)) return;
    Object.assign(this, { heard, heardAt: this.tick() });
  }

  /** Ask, and hear what time it is on the other side. */
  listening(ask) {
    return async (...all) => {
      const answer = await ask(...all), said = answer.ok ? Date.parse(answer.headers.get("date")) : NaN;
      if (said) Object.assign(this, { heard: said, heardAt: this.tick(), fast: this.now().getTime() - said });
      return answer;
    };
  }

  /** The least that it can be, in milliseconds, or null where nothing was ever heard. */
  least() { return this.heard === null ? null : Math.round(this.heard + this.tick() - this.heardAt); }

  /** The time as far as it is known, in milliseconds. */
  best() { return this.isWrong() ? this.least() : this.now().getTime(); }

  /** Whether the clock is known to be wrong. */
  isWrong() {
    const least = this.least(), ahead = this.now().getTime() - least;
    return least !== null && (ahead < -WRONG_MS || (this.fast > WRONG_MS && ahead > WRONG_MS));
  }
}
