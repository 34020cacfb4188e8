// What was typed last is sent before the page is turned.

import assert from "node:assert/strict";
import { test } from "node:test";

import { waitForBoxes } from "../src/turning.js";

const heard = {}, again = [];
globalThis.document = { addEventListener: (kind, hear) => { heard[kind] = hear; } };
globalThis.window = { dispatchEvent: (event) => { again.push(event.kind); window.goesBack(event); } };
globalThis.location = { href: "/" };
globalThis.history = { replaceState: (_, __, href) => { location.href = href; } };
globalThis.PopStateEvent = class { constructor(kind) { this.kind = kind; } };

test("a link waits for a box that was left for it, and only for that", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  let now = 1000;
  waitForBoxes();
  const turned = [], link = { click: () => press() || turned.push(now) };
  const press = (more = {}) => {
    let stopped = false;
    heard.click({ target: { closest: () => link }, preventDefault() {}, stopImmediatePropagation() { stopped = true; }, ...more });
    return stopped;
  };
  assert.equal(press(), false, "no box was left");
  heard.focusout({ target: { tagName: "BUTTON" } });
  assert.equal(press(), false);
  heard.focusout({ target: { tagName: "INPUT" } });
  assert.equal(press({ ctrlKey: true }), false);
  assert.equal(press({ target: { closest: () => null } }), false);
  assert.equal(press(), true);
  assert.deepEqual(turned, []);
  now += 250;
  context.mock.timers.tick(250);
  assert.deepEqual(turned, [1250]);
  assert.equal(press(), false, "it is turned then");
  heard.focusout({ target: { tagName: "INPUT" } });
  press();
  heard.pointerdown({ target: { closest: () => link } });
  assert.equal(turned.length, 1, "the second press of two is the same link's");
  heard.pointerdown({ target: { closest: () => null } });
  assert.deepEqual(turned, [1250, 1250], "a press elsewhere comes after the link");
  heard.pointerdown({ target: { closest: () => null } });
  context.mock.timers.tick(500);
  assert.equal(turned.length, 2, "and it is turned once");
});

test("a browser that was busy since a box was left has not sent it yet", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  let stopped = false, now = 1000;
  context.mock.method(performance, "now", () => now);
  const press = () => heard.click({ target: { closest: () => ({ click() {} }) }, preventDefault() {}, stopImmediatePropagation() { stopped = true; } });
  heard.focusout({ target: { tagName: "INPUT" } });
  now += 1000; // and no timer's turn came
  press();
  assert.equal(stopped, true);
});

test("who goes back leaves the box first, and goes back then", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const left = [], back = () => {
    let stopped = false;
    window.goesBack({ stopImmediatePropagation() { stopped = true; } });
    return stopped;
  };
  document.activeElement = { tagName: "BUTTON" };
  assert.equal(back(), false);
  document.activeElement = { tagName: "INPUT", blur() { left.push("box"); document.activeElement = { tagName: "BODY" }; } };
  assert.equal(back(), true);
  setTimeout(() => { left.push("sent"); location.href = "/ahead"; }); // by the page, as it is left
  context.mock.timers.tick(0);
  context.mock.timers.tick(0);
  assert.deepEqual([left, again, location.href], [["box", "sent"], ["popstate"], "/"]);
});
