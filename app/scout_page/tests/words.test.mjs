// Days and chances are said as the app says them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { chanceSaid, dayOf, say, speak } from "../src/words.js";

const SAID = {
  en: ["Mon 16 Nov", "Sat 21 Nov", "Mon 21 Sep"],
  he: ["ב׳ 16 בנוב׳", "שבת 21 בנוב׳", "ב׳ 21 בספט׳"],
  ar: ["الاثنين 16 نوفمبر", "السبت 21 نوفمبر", "الاثنين 21 سبتمبر"],
  es: ["lun 16 nov", "sáb 21 nov", "lun 21 sept"],
};

for (const [language, said] of Object.entries(SAID)) {
  test(`a day has its weekday, day and month in ${language}`, () => {
    assert.deepEqual(["2026-11-16", "2026-11-21", "2026-09-21"].map((day) => dayOf(day, language)), said);
  });
}

test("words after a number are those of one or of more", async (t) => {
  t.mock.method(globalThis, "fetch", async () => ({ json: async () => ({ progress: "{done} {done:hecha|hechas}, {left:queda|quedan} {left}" }) }));
  globalThis.document = { documentElement: {} };
  t.after(() => { delete globalThis.document; });
  await speak("es");
  assert.deepEqual([[1, 0], [0, 1], [2, 12]].map(([done, left]) => say("progress", { done, left })), ["1 hecha, quedan 0", "0 hechas, queda 1", "2 hechas, quedan 12"]);
});

test("no chance is said to be nothing or all", async (t) => {
  const words = { chance: "Chance {n} %", chance_least: "least", chance_most: "most" };
  t.mock.method(globalThis, "fetch", async () => ({ json: async () => words }));
  globalThis.document = { documentElement: {} };
  t.after(() => { delete globalThis.document; });
  await speak("en");
  const said = [0, 1, 99, 994, 995, 1000].map(chanceSaid);
  assert.deepEqual(said, ["least", "Chance 0.1 %", "Chance 9.9 %", "Chance 99 %", "most", "most"]);
});
