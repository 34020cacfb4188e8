// The scout's page: what was there last is shown first, the network comes second.

import { Field } from "./field.js";
import { Page } from "./page.js";
import { Runner } from "./runner.js";
import { openStore } from "./store.js";
import { Sync } from "./sync.js";
import { phones, say, speak } from "./words.js";

const isApple = "standalone" in navigator;
// a disk is waited for so long before it is said, and so long before it is asked for again
const SLOW_MS = 5000, AGAIN_MS = 1000;

/** What a code says in the address; null if there is none. */
function codeInAddress() {
  const said = new URLSearchParams(location.hash.slice(1));
  return said.get("season") && said.get("key") ? said : null;
}

/** Who may do what, from the address that the code holds; the key is then out of sight. */
function accessOfAddress() {
  const said = codeInAddress();
  if (!said) return {};
  // an iPhone's home screen keeps the address, and nothing else of the browser
  if (!isApple) history.replaceState(null, "", location.pathname);
  const access = { season: said.get("season"), key: said.get("key"), on: said.get("on") || null };
  return { access, language: said.get("lang") };
}

/** A code that is opened where the page is open changes no more than the address behind #. */
function beginAnewWithCode() {
  if (codeInAddress()) location.reload();
}

/** The phone's disk. As long as it cannot be had, as in some private windows, that is said and it is tried again. */
async function storeOfPhone() {
  const slow = setTimeout(sayNoDisk, SLOW_MS);
  for (;;) {
    try {
      const store = await openStore();
      clearTimeout(slow);
      return store;
    } catch {
      await sayNoDisk();
      await new Promise((done) => setTimeout(done, AGAIN_MS));
    }
  }
}

async function sayNoDisk() {
  const root = document.getElementById("page");
  if (root.children.length > 0) return;
  const said = document.createElement("p");
  said.className = "large";
  said.setAttribute("role", "alert");
  root.append(said);
  await speak(phones()).catch(() => {}); // without a network, the words may be out of reach, too
  said.textContent = say("no_disk");
}

async function begin() {
  if (isApple) document.querySelector("link[rel=manifest]")?.remove();
  const { access, language } = accessOfAddress();
  addEventListener("hashchange", beginAnewWithCode);
  const store = await storeOfPhone();
  const field = new Field(store);
  const page = new Page(document.getElementById("page"), field, store);
  // a full phone cannot keep a code, but what is on it
  let notKept = null;
  const opened = field.open(access).catch((error) => { notKept = error; return field.open(); });
  const [choices, ofCode] = await Promise.all([store.get("choices"), store.languageOfCode(language), opened]);
  await page.build({ language: ofCode ?? phones(), theme: "auto", hand: "right", ...choices });
  page.map.look(field.plant);
  document.documentElement.dataset.ready = Math.round(performance.now());
  if (notKept) page.sayNotKept(notKept);
  await later(page, field, store, notKept ? null : access);
}

/** What a first screen does not need. */
async function later(page, field, store, access) {
  const runner = new Runner(new Sync(store, field.ask), field, (...all) => page.sending(...all));
  const others = new BroadcastChannel("fieldmon");
  page.onTold = () => runner.afterTap();
  page.onStep = () => others.postMessage("step");
  // another window of this page noted or told something, or turned to another season
  others.onmessage = async () => { await field.open(); await page.refresh(); };
  if ("serviceWorker" in navigator) navigator.serviceWorker.register("worker.js", { updateViaCache: "none" }).catch(() => {});
  if (access) page.onStep(); // a code may bring another season
  page.persisted = (await navigator.storage?.persist?.()) ?? false;
  const moved = (coords) => { field.moved(coords); page.moved(); };
  navigator.geolocation?.watchPosition(({ coords }) => moved(coords), () => moved(null), { enableHighAccuracy: true, maximumAge: 2000 });
  setInterval(() => page.refresh(), 30000);
  if (access && !field.day) await page.load();
  runner.now();
}

begin();
