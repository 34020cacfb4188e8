// Days typed into their box: Streamlit keeps one only once the box is left, or by Escape. Who typed a day
// and pressed Enter saw it in the box over the page of another day.

const BOX = "[data-testid=stDateInput]", PART = "[role=spinbutton]";

let heard = false;

// Let a day that was typed count by Enter, and by Tab from its last part, from now on.
export function takeDays() {
  if (heard) return;
  heard = true;
  document.addEventListener("keydown", ({ key, shiftKey, target }) => {
    const box = target.closest?.(BOX);
    if (!box || !target.matches(PART)) return;
    const isLast = target === [...box.querySelectorAll(PART)].at(-1);
    if (key !== "Enter" && !(key === "Tab" && isLast && !shiftKey)) return;
    target.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape", bubbles: true, cancelable: true }));
  }, true);
}
