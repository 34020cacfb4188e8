import assert from "node:assert/strict";
import { test } from "node:test";
import { Clock } from "../src/clock.js";

const HOUR = 3600000;

/** A phone whose clock and ticks are set here, and a season that says what time it is. */
function aPhone(said = Date.parse("2026-11-22T08:00:00Z")) {
  const phone = { now: said, tick: 0 };
  const clock = new Clock(() => new Date(phone.now), () => phone.tick);
  const hear = (at) => clock.listening(async () => new Response("", { headers: { date: new Date(at).toUTCString() } }))();
  return { phone, clock, hear, said };
}

test("a clock is wrong if it is behind what was heard, or was ahead when it was heard", async () => {
  const { phone, clock, hear, said } = aPhone();
  assert.deepEqual([clock.least(), clock.isWrong()], [null, false]);
  await hear(said);
  Object.assign(phone, { now: said + HOUR, tick: HOUR });
  assert.deepEqual([clock.least(), clock.isWrong()], [said + HOUR, false]);
  phone.now += 5 * HOUR; // asleep: ticks may stand still
  assert.equal(clock.isWrong(), false);
  phone.now = said + HOUR / 2; // set back while the page is open
  assert.equal(clock.isWrong(), true);
  phone.now = said + 24 * HOUR;
  await hear(said + HOUR);
  assert.equal(clock.isWrong(), true);
  phone.now = said + HOUR; // set right
  assert.equal(clock.isWrong(), false);
});

for (const off of [3 * 60000, 24 * HOUR, -3 * HOUR, -20000 * HOUR]) {
  test(`a clock that is off runs on while the phone sleeps, until it is set right: by ${off / HOUR} h`, async () => {
    const { phone, clock, hear, said } = aPhone();
    phone.now = said + off;
    await hear(said);
    for (let k = 1; k <= 120; k++) {
      phone.now += 60000;
      phone.tick += 10000; // awake for ten seconds of each minute
      assert.equal(clock.best(), said + k * 60000);
      assert.equal(clock.isWrong(), true);
    }
    phone.now -= off;
    if (Math.abs(off) < 2 * HOUR) await hear(phone.now); // set by less than it slept, that alone tells
    assert.deepEqual([clock.best(), clock.isWrong()], [said + 2 * HOUR, false]);
  });
}

test("what was heard is known after the battery was empty", async () => {
  const { phone, clock, hear, said } = aPhone();
  await hear(said);
  phone.tick += HOUR;
  const next = aPhone();
  next.clock.knew(clock.least());
  next.phone.now = 0;
  assert.deepEqual([next.clock.least(), next.clock.isWrong()], [said + HOUR, true]);
});

test("how far ahead it was is known, too, once the page is opened again, and said in a file", async () => {
  const { phone, clock, hear, said } = aPhone();
  phone.now = said + 24 * HOUR;
  await hear(said);
  const next = aPhone(), { heard, fast } = clock.known();
  next.clock.knew(heard, fast);
  next.phone.now = phone.now + HOUR;
  assert.deepEqual([next.clock.best(), next.clock.isWrong()], [said + HOUR, true]);
  assert.deepEqual(next.clock.said(), { clock: "2026-11-23T09:00:00.000Z", time: "2026-11-22T09:00:00.000Z" });
  next.phone.now = said + HOUR; // set right meanwhile
  assert.equal(next.clock.isWrong(), false);
});

test("what is no answer of the season says no time", async () => {
  const { clock, said } = aPhone();
  await clock.listening(async () => new Response("", { status: 502, headers: { date: new Date(said).toUTCString() } }))();
  await clock.listening(async () => new Response(""))();
  assert.equal(clock.least(), null);
});
