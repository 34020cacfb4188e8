// A tap in Scout is of the plant that is shown: until the next one is there, a second tap says nothing. The
// server has gone on to that plant before the page shows it.

const BUTTONS = "[class*=st-key-scout_buttons], [class*=st-key-scout_others], [class*=st-key-scout_back]";
// what is shown is named by how many taps were answered before
const SHOWN = "[class*=st-key-scout_after_]", NAME = /st-key-scout_after_(\d+)/;
// a tap that was lost on its way is not waited for
const LOST_MS = 10000;

let heard = false, last = null;

const shown = () => Math.max(...[...document.querySelectorAll(SHOWN)].map((one) => Number(NAME.exec(one.className)?.[1])));

// Let each plant that is shown have one tap, from now on.
export function oneTapEach() {
  if (heard) return;
  heard = true;
  document.addEventListener("click", (event) => {
    if (!event.target.closest?.("button")?.closest(BUTTONS)) return;
    const now = performance.now(), of = shown();
    if (last?.of === of && now - last.at < LOST_MS) {
      event.preventDefault();
      event.stopImmediatePropagation();
      return;
    }
    last = { of, at: now };
  }, true);
}
