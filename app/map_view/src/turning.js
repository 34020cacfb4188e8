// A page is turned after what was typed last: Streamlit sends a box's value a moment after it is left, with
// the page that it stood on. Who typed and tapped a link at once was turned back.

const MOMENT_MS = 250;

let heard = false, left = -Infinity, waiting = null;

function turn() {
  const { link, timer } = waiting;
  clearTimeout(timer);
  waiting = null;
  left = -Infinity; // this click is not to wait
  link.click();
}

// Let links wait a moment for the box that was left for them, from now on.
export function waitForBoxes() {
  if (heard) return;
  heard = true;
  document.addEventListener("focusout", ({ target }) => {
    if (target.tagName === "INPUT" || target.tagName === "TEXTAREA") left = performance.now();
  }, true);
  document.addEventListener("click", (event) => {
    const link = event.target.closest?.("a[href]");
    const asked = event.button || event.ctrlKey || event.metaKey || event.shiftKey; // a window of its own
    if (!link || asked || performance.now() - left >= MOMENT_MS) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    clearTimeout(waiting?.timer);
    waiting = { link, timer: setTimeout(turn, MOMENT_MS) };
  }, true);
  // what is pressed meanwhile comes after it: a page that turns then would drop that press
  document.addEventListener("pointerdown", ({ target }) => {
    if (waiting && target.closest?.("a[href]") !== waiting.link) turn();
  }, true);
}
