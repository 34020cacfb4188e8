// How often the map is asked for a frame: as the browser draws while something moves, a few times a second while
// nothing does. deck.gl asks for the next frame whether it will draw or not: a tenth of a processor.

const STILL_FRAMES = 10, LOOK_MS = 250;

// What deck.gl asks for its frames. `told` hears whether the map rests.
export class Pace {
  constructor(told) {
    this.told = told;
    this.still = 0; // frames since something was drawn, or may have to be
    this.timer = this.frame = null;
  }

  requestAnimationFrame(call) {
    this.call = call;
    this.still++;
    if (this.still === STILL_FRAMES) this.told(true);
    if (this.still < STILL_FRAMES) this.ask();
    else this.timer = setTimeout(() => this.ask(), LOOK_MS); // an image may have come meanwhile
    return 1;
  }

  cancelAnimationFrame() {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.frame);
    this.timer = this.frame = null;
  }

  ask() {
    this.timer = null;
    this.frame = requestAnimationFrame((now) => {
      this.frame = null;
      this.call(now);
    });
  }

  wake() {
    if (this.still >= STILL_FRAMES) this.told(false);
    this.still = 0;
    if (this.timer === null) return;
    clearTimeout(this.timer);
    this.ask();
  }
}
