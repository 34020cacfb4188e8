// A page is turned after what was typed last: Streamlit sends a box's value a moment after it is left, with
// the page that it stood on. Who typed and tapped a link at once was turned back, and who went back with the
// keyboard still in the box had typed for nothing.

import { wentBack } from "./address.js";

const MOMENT_MS = 250;

// `left` is there until Streamlit's own timer, which comes before it, has sent what was typed: by the clock
// alone a browser that is busy would be too late
let heard = false, left = null, waiting = null;

const isBox = ({ tagName }) => tagName === "INPUT" || tagName === "TEXTAREA";

function forget() {
  clearTimeout(left);
  left = null;
}

function turn() {
  const { link, timer } = waiting;
  clearTimeout(timer);
  waiting = null;
  forget(); // this click is not to wait
  link.click();
}

// Let links, and who goes back, wait a moment for the box that was left for them, from now on.
export function waitForBoxes() {
  if (heard) return;
  heard = true;
  document.addEventListener("focusout", ({ target }) => {
    if (!isBox(target)) return;
    forget();
    left = setTimeout(forget, MOMENT_MS);
  }, true);
  document.addEventListener("click", (event) => {
    const link = event.target.closest?.("a[href]");
    const asked = event.button || event.ctrlKey || event.metaKey || event.shiftKey; // a window of its own
    if (!link || asked || left === null) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    clearTimeout(waiting?.timer);
    waiting = { link, timer: setTimeout(turn, MOMENT_MS) };
  }, true);
  // what is pressed meanwhile comes after it: a page that turns then would drop that press
  document.addEventListener("pointerdown", ({ target }) => {
    if (waiting && target.closest?.("a[href]") !== waiting.link) turn();
  }, true);
  // the address is another already: the page hears of it once what was typed is sent, by a timer of Streamlit's
  // that begins as the box is left. Called before all who hear of it: see serve.py
  window.goesBack = (event) => {
    const box = document.activeElement;
    if (!box || !isBox(box)) return;
    event.stopImmediatePropagation();
    wentBack();
    const { state } = event, { href } = location;
    box.blur();
    setTimeout(() => setTimeout(() => {
      // the page may have written its own address again
      if (location.href !== href) history.replaceState(state, "", href);
      window.dispatchEvent(new PopStateEvent("popstate", { state }));
    }));
  };
}
