// The scale bar and the north arrow of a map, which follow its zoom, and clicks as exact positions.
//
// Streamlit's bundle holds none of deck.gl's own widgets, and tells of a click only which thing was
// hit. So deck.gl is asked itself, through the React element that Streamlit draws it with. Where a
// later Streamlit hides it, the bar is that of the first view and says so, and no click is heard.

const LONGEST_PX = 120, POLL_MS = 120, STILL_PX = 6, TWICE_MS = 350;

function deckOf(canvas) {
  const name = Object.keys(canvas).find((key) => key.startsWith("__reactFiber$"));
  for (let fiber = canvas[name], up = 0; fiber && up < 12; fiber = fiber.return, up++) {
    for (let hook = fiber.memoizedState; hook && hook.next !== undefined; hook = hook.next) {
      const kept = Array.isArray(hook.memoizedState) ? hook.memoizedState[0] : hook.memoizedState;
      for (const holder of [kept, kept?.current]) if (holder?.deck?.getViewports) return holder;
    }
  }
  return null;
}

function metresPerPixel(view) {
  const around = 40075016.686 * Math.cos((view.latitude * Math.PI) / 180);
  return around / (512 * 2 ** view.zoom);
}

class ScaleBar {
  constructor(root) {
    this.root = root;
    this.bar = root.querySelector(".bar");
    this.text = root.querySelector(".text");
    this.north = root.querySelector(".north");
    this.points = [];
    this.timer = setInterval(() => this.follow(), POLL_MS);
  }

  show(data, tell) {
    this.data = data;
    this.tell = tell;
    this.drawn = "";
    this.follow();
  }

  follow() {
    const canvas = this.above();
    if (canvas && canvas !== this.canvas) {
      this.canvas = canvas;
      this.found = null;
      this.listen(canvas.parentElement);
    }
    if (canvas && !this.found) this.found = deckOf(canvas);
    const view = this.viewport();
    this.draw(view ?? this.data.view, view ? "" : this.data.first);
    const frame = canvas?.closest("[data-testid=stFullScreenFrame]");
    const full = frame !== null && frame !== undefined &&
      getComputedStyle(frame).position === "fixed";
    this.root.classList.toggle("full", full);
  }

  // the map stands before this element: a box around both would forget the map's zoom when it moves
  above() {
    let here = this.root.getRootNode().host?.closest("[data-testid=stElementContainer]");
    while (here && !here.querySelector(".stDeckGlJsonChart")) here = here.previousElementSibling;
    return here?.querySelector(".stDeckGlJsonChart canvas") ?? null;
  }

  viewport() {
    return this.found?.deck?.isInitialized ? this.found.deck.getViewports()[0] : null;
  }

  draw(view, more) {
    const now = `${view.zoom} ${view.latitude} ${view.bearing} ${more}`;
    if (now === this.drawn) return;
    this.drawn = now;
    const metre = 1 / metresPerPixel(view);
    const fits = this.data.lengths.filter(([metres]) => metres * metre <= LONGEST_PX);
    const [metres, text] = fits.length ? fits[fits.length - 1] : this.data.lengths[0];
    this.bar.style.width = `${metres * metre}px`;
    this.text.textContent = text + more;
    this.north.style.transform = `rotate(${-(view.bearing ?? 0)}deg)`;
    this.root.setAttribute("aria-label", this.data.alt.replace("{bar}", text + more));
  }

  listen(place) {
    place.addEventListener("pointerdown", (event) => { this.down = event; });
    place.addEventListener("pointerup", (event) => {
      const from = this.down, before = this.last;
      const near = (one) => Math.hypot(event.clientX - one.clientX, event.clientY - one.clientY);
      const view = this.viewport();
      if (!this.data.draws || !view || !from || event.button || near(from) > STILL_PX) return;
      this.last = event;
      // the second half of a double click, which zooms
      if (before && event.timeStamp - before.timeStamp < TWICE_MS && near(before) < STILL_PX) return;
      const box = place.getBoundingClientRect();
      const [lon, lat] = view.unproject([event.clientX - box.left, event.clientY - box.top]);
      // all of the last ones: the server may hear of two at once
      this.points = [...this.points.slice(-20), [Date.now(), lon, lat]];
      this.tell("points", this.points);
    });
  }
}

export default function ({ data, parentElement, setStateValue }) {
  const root = parentElement.querySelector(".scale-bar");
  root.scaleBar ??= new ScaleBar(root);
  root.scaleBar.show(data, setStateValue);
  return () => clearInterval(root.scaleBar.timer);
}
