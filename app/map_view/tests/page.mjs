// Stands for the browser's page where a test needs no more than elements, words and clicks.

class Node_ {
  constructor(kind) {
    Object.assign(this, { kind, children: [], attributes: {}, heard: {}, textContent: "", hidden: false, value: "", dataset: {} });
    this.style = { setProperty: (name, value) => { this.style[name] = value; } };
  }
  get firstChild() { return this.children[0]; }
  set innerHTML(text) { this.textContent = text; }
  append(...more) { this.children.push(...more); }
  appendChild(one) { this.children.push(one); return one; }
  replaceChildren(...all) { this.children = all; }
  setAttribute(name, value) { this.attributes[name] = String(value); if (name === "value") this.value = value; }
  getAttribute(name) { return this.attributes[name] ?? null; }
  toggleAttribute(name, on) { if (on) this.attributes[name] = ""; else delete this.attributes[name]; }
  addEventListener(name, act) { (this.heard[name] ??= []).push(act); }
  removeEventListener() {}
  fire(name, event = {}) { for (const act of this.heard[name] ?? []) act(event); }
  attachShadow() { this.shadow = new Node_("shadow"); return this.shadow; }
  setPointerCapture() {}
  remove() { this.gone = true; }
  all() { return [this, ...this.children.flatMap((one) => (one.all ? one.all() : []))]; }
}

// Return a page on which nothing lies yet, and make it the one that scripts see.
export function page() {
  const made = { body: new Node_("body"), documentElement: new Node_("html"), panel: null };
  globalThis.document = {
    body: made.body, documentElement: made.documentElement,
    createElement: (kind) => new Node_(kind), createElementNS: (_, kind) => new Node_(kind),
    querySelectorAll: () => [],
    querySelector: () => made.panel && { getBoundingClientRect: () => made.panel },
  };
  globalThis.window = { addEventListener() {}, removeEventListener() {}, dispatchEvent() {} };
  globalThis.CSSStyleSheet = class { replaceSync() {} };
  return made;
}

export const place = () => new Node_("div");
