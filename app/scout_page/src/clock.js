// What is known of the phone's clock: it may be wrong after the battery was empty, and be set at any time.
// The season's time, last heard, is the least that it can be; what has passed since runs on where the page stays open and awake.

const WRONG_MS = 120000;

export class Clock {
  /** `now` is the phone's clock, `tick` counts milliseconds since the page was opened. */
  constructor(now = () => new Date(), tick = () => performance.now()) { Object.assign(this, { now, tick, heard: null, heardAt: null, fast: 0, isOfNow: false }); }

  /** What is known, for when the page is opened again. */
  known() { return { heard: this.least(), fast: this.fast }; }

  /** What was known when the page was closed; pages of before did not keep how far the clock was off. */
  knew(heard, fast = this.fast) {
    if (!heard || heard <= (this.least() ?? 0)) return;
    Object.assign(this, { heard, heardAt: this.tick(), fast });
  }

  /** What the phone's clock says, and what time it is as far as that is known, for a file. */
  said() { return { clock: this.now().toISOString(), time: new Date(this.best()).toISOString() }; }

  /** Ask, and hear what time it is on the other side. */
  listening(ask) {
    return async (...all) => {
      const answer = await ask(...all), said = answer.ok ? Date.parse(answer.headers.get("date")) : NaN;
      if (said) Object.assign(this, { heard: said, heardAt: this.tick(), fast: this.now().getTime() - said, isOfNow: true });
      return answer;
    };
  }

  /** The least that it can be, in milliseconds, or null where nothing was ever heard. */
  least() { return this.heard === null ? null : Math.round(this.heard + this.tick() - this.heardAt); }

  /** The time as far as it is known, in milliseconds: by the clock as far off as it was, or set right since; ticks stand still asleep. */
  best() {
    const now = this.now().getTime(), least = this.least();
    if (least === null) return now;
    const can = [now, now - this.fast].filter((one) => one > least - WRONG_MS);
    return Math.max(least, can.length ? Math.min(...can) : least);
  }

  /**
   * The season's time, in milliseconds, or null where it is not known: heard since the page was opened, by a clock that
   * was not set back since. While the page was closed the battery may have run out, and the clock with it.
   */
  sure() {
    const time = this.now().getTime() - this.fast;
    return this.isOfNow && time > this.least() - WRONG_MS ? time : null;
  }

  /** Whether the clock is known to be wrong. */
  isWrong() { return Math.abs(this.now().getTime() - this.best()) > WRONG_MS; }
}
