// What is seen and touched: the map, the next plant, large buttons, and a menu.

import { arrowOf, hasNames, plantAt, rowsCalled, shownEnds, signOf, twinOf } from "./geo.js";
import { PlotMap } from "./map.js";
import { scaled } from "./photo.js";
import { Held, KeyEnded, NotNow } from "./sync.js";
import { LANGUAGES, chanceSaid, dayOf, own, say, speak } from "./words.js";

// a glove that bounces must say nothing of the next plant
const REST_MS = 250;
const STAGES = ["egg", "young", "adult", "web"];
// the word of a result; that of a plant that is gone goes before "could not inspect"
const resultOf = (one) => say(one.gone ? "gone" : one.result);
// where a plant stands; of two faces in one place, which
function placeOf(plot, plant) {
  const number = plot.number[plant], face = plot.face?.[plant];
  return say("place", { row: signOf(plot, plant), plant: face ? say("face", { number, face }) : number });
}
const whoSays = (some) => some.map((one) => say("who_says", { who: one.who, result: resultOf(one) })).join(", ");
// so many plants that contradict are named; in the app all are
const MOST_NAMED = 3;
const LEFT_OUT = { skipped: "left_out_skipped", flagged: "left_out_flagged", unwanted: "left_out_unwanted" };

function h(name, values = {}, ...inner) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(values)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value != null) made.setAttribute(key, value);
  }
  made.append(...inner.filter((one) => one != null && one !== false));
  return made;
}

export class Page {
  constructor(root, field, store) {
    Object.assign(this, { root, field, store });
    this.state = "idle";
    this.stranded = new Map();
    this.rests = 0;
    this.left = { records: 0, photos: 0, refused: [] };
  }

  /** Lay the page out in the language, theme and hand chosen. */
  async build(choices) {
    this.choices = choices;
    this.choices.language = await speak(choices.language);
    this.#dress();
    this.canvas = h("canvas", { id: "map", tabindex: "0", role: "img", "aria-label": say("map") });
    this.bar = h("header", { id: "bar" });
    this.note = h("p", { id: "note", role: "status", "aria-live": "polite" });
    this.sheet = h("main", { id: "sheet" });
    const before = this.menu; // it may have been closed since something was chosen in it
    this.menu = h("dialog", { id: "menu" });
    const tool = (name, act, sign) => h("button", { type: "button", class: "tool", title: say(name), "aria-label": say(name), onclick: act }, sign);
    const tools = h("div", { id: "tools" }, tool("zoom_in", () => this.map.zoom(1.6), "+"), tool("zoom_out", () => this.map.zoom(1 / 1.6), "−"),
      tool("to_next", () => this.map.look(this.field.plant), "◎"), tool("whole_plot", () => this.map.fit(), "⛶"));
    const chosenInMenu = before?.open && before.dataset.of === "menu";
    this.root.replaceChildren(this.bar, h("section", { id: "stage", "aria-label": say("map_of") }, this.canvas, tools, this.note), this.sheet, this.menu);
    this.map = new PlotMap(this.canvas, { picked: (plant, isSure) => (isSure ? this.#act(() => this.field.goTo(plant)) : this.#goTo(plant)) });
    this.map.theme = this.theme;
    this.#laidOut = null;
    if (chosenInMenu) this.#openMenu();
    await this.refresh();
  }

  #laidOut = null;
  #shown = null;
  #of = null;

  get theme() {
    const { theme } = this.choices;
    return theme === "auto" ? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "sun") : theme;
  }

  #dress() {
    document.documentElement.dataset.theme = this.theme;
    document.documentElement.dataset.hand = this.choices.hand;
  }

  async choose(changes) {
    Object.assign(this.choices, changes);
    this.#dress(); // hand and theme are seen at once
    await this.store.put({ choices: this.choices });
    await this.build(this.choices);
  }

  /** How sending goes. */
  async sending(state, stranded) {
    Object.assign(this, { state, stranded });
    this.left = await this.store.left();
    this.#drawBar();
    if (this.menu.open && this.menu.dataset.of === "menu") this.#openMenu();
    if (state !== "sent") return;
    if (this.#shown !== this.field.day) {
      if (!this.#shown) this.#say(""); // it was loaded now
      this.#drawSheet();
    }
    this.#drawMap();
  }

  async refresh() {
    this.left = await this.store.left();
    this.#drawBar();
    this.#drawSheet();
    this.#drawMap();
  }

  /** Take a step: it is seen at once, and said to be kept when it is on the disk, or that it could not be. */
  async #act(work, beat) {
    let kept;
    try { kept = work(); } catch (error) { kept = Promise.reject(error); }
    this.#say("");
    this.#draw();
    try {
      await kept;
      this.onStep?.();
      if (beat) navigator.vibrate?.(beat);
    } catch (error) {
      this.sayNotKept(error);
      this.#draw();
    }
    this.#drawLast();
    this.left = await this.store.left(); // before the bar is drawn: it would say that all is sent
    this.#drawBar();
  }

  sayNotKept(error) {
    navigator.vibrate?.([200, 100, 200]);
    this.#say(say(error?.name === "QuotaExceededError" ? "phone_full" : "not_kept", { why: error?.message ?? "" }), true);
  }

  #draw() {
    this.#drawBar();
    this.#drawSheet();
    this.#drawMap(true);
  }

  #say(text, bad = false) {
    this.note.textContent = text;
    this.note.classList.toggle("bad", bad);
  }

  // -- map

  #drawMap(late = false) {
    const { field } = this;
    if (!field.plot || !field.day) { this.#laidOut = null; return this.map.clear(); }
    if (this.#laidOut !== field.day) { this.#laidOut = field.day; this.map.lay(field.plot, field.day.chance, field.day.spots); }
    const asked = field.asked().map((one) => one.plant);
    this.map.show({ ...field.known(), ahead: field.inHours(), way: field.way(), asked, next: field.plant, position: field.position }, late);
  }

  moved() {
    this.#drawMap();
    this.#drawPlace();
  }

  // -- bar

  #drawBar() {
    const { field } = this;
    const far = field.day && field.progress();
    const said = far ? [
      h("b", {}, say(far.fits ? "progress" : "progress_in_time", far)),
      h("span", { id: "hours" }, this.#hours()),
    ] : [h("b", {}, "fieldmon")];
    const n = this.left.records + this.left.photos + field.unwritten();
    const ended = this.state === "ended" || (this.state === "sent" && this.stranded.size > 0), done = n || this.left.refused.length ? "" : "✓", waits = navigator.onLine ? "↑" : "⏸";
    const signs = { offline: "⏸", held: "⏸", ended: "⚠", sending: done || "↑", sent: done || (n ? waits : ""), idle: "" };
    const text = n ? say("waiting", { n }) : this.left.refused.length ? say("some_refused", { n: this.left.refused.length }) : say("all_sent");
    // the button stays the same: a keyboard may stand on it
    if (!this.bar.hasChildNodes()) {
      this.bar.append(h("div", { class: "said" }), h("span", { id: "sync" }),
        h("button", { type: "button", id: "open_menu", "aria-label": say("menu"), onclick: () => this.#openMenu() }, "☰"));
    }
    const [head, sync] = this.bar.children;
    head.replaceChildren(...said);
    sync.className = ended || this.left.refused.length ? "bad" : "";
    Object.assign(sync.dataset, { state: this.state, left: n });
    sync.textContent = `${ended ? signs.ended : signs[this.state]} ${text}`;
  }

  #hours() {
    if (this.field.hasNoRoute()) return "";
    const left = this.field.secondsLeft(), minutes = Math.round(left / 60);
    return left > 0 ? say("time_left", { hours: Math.floor(minutes / 60), minutes: String(minutes % 60).padStart(2, "0") }) : say("time_over");
  }

  // -- the next plant

  /** The sheet anew; a keyboard stays where it was, or comes to what is asked next. */
  #drawSheet() {
    const was = this.sheet.contains(document.activeElement) ? document.activeElement.id : null;
    this.#layOut();
    if (was === null) return;
    const again = [was, "save", "clean"].filter(Boolean).map((id) => document.getElementById(id)).find((one) => this.sheet.contains(one));
    again?.focus({ preventScroll: true });
  }

  #layOut() {
    const { field } = this;
    this.#shown = field.day;
    this.#of = field.season;
    if (!field.access) return this.sheet.replaceChildren(h("p", { class: "large" }, say("scan")));
    if (!field.day) {
      return this.sheet.replaceChildren(h("p", { class: "large" }, say("not_loaded", { season: field.season })),
        h("button", { type: "button", class: "wide main", onclick: () => this.load() }, say("load_day")));
    }
    const { draft } = field;
    if (draft.plant < 0) {
      return this.sheet.replaceChildren(...this.#old(), h("p", { class: "large", id: "place", "data-plant": -1 }, say(field.hasNoRoute() ? "no_route" : "route_done")), ...this.#closed(), ...this.#leftOut(), this.#lastSaid(), this.#others(), ...this.#back());
    }
    this.place = h("div", { id: "place", "data-plant": draft.plant });
    this.#drawPlace();
    this.sheet.replaceChildren(...this.#old(), this.place, draft.open ? this.#details() : this.#buttons(), this.#lastSaid(), this.#others());
  }

  /** What was told last, and whether it is on the disk. */
  #lastSaid() {
    this.last = h("p", { id: "last", class: "small" });
    this.#drawLast();
    return this.last;
  }

  #drawLast() {
    const one = this.field.day && this.field.lastRecord();
    if (!this.last) return;
    this.last.hidden = !one;
    if (!one) return this.last.replaceChildren();
    const isKept = one.state !== "writing", { plot } = this.field;
    const what = `${placeOf(plot, one.plant)}: ${resultOf(one)}`;
    Object.assign(this.last.dataset, { plant: one.plant, kept: isKept });
    const n = this.field.added();
    this.last.textContent = `${say(isKept ? "kept" : "keeping", { what })}${n ? ` · ${say("added", { n })}` : ""}`;
  }

  #old() {
    const { field } = this, wrong = field.time.isWrong() ? [h("p", { class: "tag", id: "clock" }, say("clock_wrong"))] : [];
    const newer = field.hasNewer() && !field.isOld() ? [h("button", { type: "button", class: "wide", id: "newer", onclick: () => this.load() }, say("newer_plan"))] : [];
    return [...wrong, ...this.#otherDay(), ...newer, ...this.#takenBack(), ...this.#takenBackBefore(), ...this.#contradictions()];
  }

  /** Where others say otherwise of a plant, as the season told it. */
  #contradictions() {
    const { field } = this, { plot } = field, all = field.contradictions();
    const line = ({ plant, said }) => say("contradiction", { what: `${placeOf(plot, plant)}: ${whoSays(said)}` });
    const lines = all.slice(0, MOST_NAMED).map((one) => h("p", { class: "bad small contradiction", "data-plant": one.plant }, line(one)));
    return all.length > MOST_NAMED ? [...lines, h("p", { class: "bad small" }, say("and_more", { n: all.length - MOST_NAMED }))] : lines;
  }

  /** The same of days before, once: the phone has these records no more. */
  #takenBackBefore() {
    const days = this.field.takenBackBefore().map(({ day, n }) => h("p", { class: "bad" }, say("taken_back_before", { day: dayOf(day), n })));
    if (!days.length) return [];
    const read = () => this.#act(() => this.field.readTakenBack());
    return [h("div", { id: "taken_back_before" }, ...days, h("p", {}, say("taken_back_why")), h("button", { type: "button", class: "wide", id: "read", onclick: read }, say("ok")))];
  }

  /** That records count no more, as somebody took them back in the season: which, and what is to come of them. */
  #takenBack(id = "taken_back") {
    const n = this.field.takenBack().length;
    return n ? [h("button", { type: "button", class: "wide bad", id, onclick: () => this.#askTakenBack() }, say("taken_back", { n }))] : [];
  }

  #askTakenBack() {
    const { field } = this, { plot } = field, title = say("taken_back", { n: field.takenBack().length });
    const answer = (name, again) => h("button", { type: "button", class: again ? "wide main" : "wide", id: name, onclick: () => {
      this.menu.close();
      this.#act(() => field.answer(again)).then(() => { this.#draw(); this.onTold?.(); });
    } }, say(name));
    const which = (one) => h("li", {}, `${placeOf(plot, one.plant)}: ${resultOf(one)}`);
    this.#show(h("div", {}, h("h2", {}, title), h("p", {}, say("taken_back_why")), h("ul", {}, ...field.takenBack().map(which)),
      answer("tell_again", true), answer("let_go", false),
      h("button", { type: "button", class: "wide", onclick: () => this.menu.close() }, say("close"))), title, "taken_back");
  }

  /** Where nobody may be yet, and how many plants are not on the route for it. */
  #closed() {
    const said = ({ rows, until, own: n }, [low, high] = shownEnds(this.field.plot, rows)) => [say("closed_rows", { low, high, until: this.#time(until) }), n && say("closed_plants", { n })];
    return (this.field.day ? this.field.closed() : []).map((one) => h("p", { class: "bad" }, said(one).filter(Boolean).join(" ")));
  }

  /** How many plants plans leave out, and why. */
  #leftOut() { return this.field.leftOut().map(({ why, own: n }) => h("p", { class: "left_out" }, say(LEFT_OUT[why], { n }))); }

  #otherDay() {
    const { field } = this;
    if (field.isOld()) return [h("button", { type: "button", class: "wide bad", id: "old", onclick: () => this.load() }, say("old_day", { day: dayOf(field.day.day) }))];
    return field.meant() ? [h("p", { class: "tag", id: "other_day" }, say("other_day", { day: dayOf(field.day.day) }))] : [];
  }

  #drawPlace() {
    const { field, place } = this;
    if (!place || field.plant < 0 || !field.day) return;
    const { plot, plant } = field, away = field.metresAway();
    const where = away == null ? say("no_position") : field.isThere() ? say("there") : say("away", { m: Math.round(away) });
    place.replaceChildren(
      // a number stays with its word
      h("h1", {}, placeOf(plot, plant).replace(/ (?=\W?\d)/g, "\u00a0")),
      h("p", {}, h("span", { class: field.isThere() ? "good" : "" }, where),
        // what was seen today is no chance
        !field.done.has(plant) && !field.back.has(plant) && h("span", {}, chanceSaid(field.day.chance[plant])),
        field.offRoute && h("span", { class: "tag" }, say("off_route"))),
    );
    const closed = field.closedUntil(plant);
    if (closed) place.append(h("p", { class: "bad", id: "closed" }, say("closed", { until: this.#time(closed) })));
    for (const one of field.asked(plant)) {
      const taken = field.draft.photos > 0;
      place.append(h("p", { class: "asked", "data-taken": String(taken) }, `${taken ? "✓" : "▣"} ${one.note ? say("photo_asked_of", { note: one.note }) : say("photo_asked")}`));
    }
    if (field.isGone(plant) && !field.own.has(plant)) place.append(h("p", { id: "is_gone" }, say("gone")));
    const contradicting = field.contradictions().some((one) => one.plant === plant), known = field.said(plant);
    if (known.length && !contradicting) place.append(h("p", {}, whoSays(known)));
  }

  /** A local time as it is said: with its day where that is not the day of the route. */
  #time(local) {
    const [day, time] = local.split("T");
    return day === this.field.day.day ? time : `${dayOf(day)}, ${time}`;
  }

  #buttons() {
    const tap = (result, beat) => h("button", { type: "button", class: result, id: result, onclick: () => this.#tell(result, beat) }, say(result));
    const found = h("button", { type: "button", class: "found", id: "found", onclick: () => this.#act(() => this.field.note({ open: true })) }, say("found"));
    return h("div", { id: "answers", "data-resting": performance.now() < this.rests }, tap("clean", 30), found, tap("skipped", 30), tap("gone", [30, 60, 30]));
  }

  async #tell(result, beat) {
    if (performance.now() < this.rests) return;
    if (result === "found" && !this.field.isCountable()) return this.#say(say("count_whole"), true);
    // another window of this page may have gone on, or this one be turning to another season
    if (this.#of !== this.field.season || Number(this.place.dataset.plant) !== this.field.plant) return this.#draw();
    this.rests = performance.now() + REST_MS;
    setTimeout(() => document.getElementById("answers")?.removeAttribute("data-resting"), REST_MS);
    const kept = this.#act(() => this.field.tell(result), beat);
    this.map.look(this.field.plant, true);
    await kept;
    this.onTold?.();
  }

  /** Count, stage, leaves and a note of a find. */
  #details() {
    const { draft } = this.field, save = (changes) => { const kept = this.field.note(changes); kept.then(() => this.onStep?.(), () => this.#act(() => kept)); };
    const number = (name) => {
      const input = h("input", { type: "number", inputmode: "numeric", min: "1", max: "1000000", id: name, value: draft[name] ?? "",
        oninput: () => save({ [name]: input.value === "" ? null : Math.max(0, Number(input.value)) }) });
      const step = (by) => () => { input.value = Math.max(0, Math.round(Number(input.value) || 0) + by) || ""; input.dispatchEvent(new Event("input")); };
      return h("div", { class: "number" }, h("label", { for: name }, say(name)),
        h("button", { type: "button", "aria-label": say("fewer", { what: say(name) }), onclick: step(-1) }, "−"), input,
        h("button", { type: "button", "aria-label": say("more", { what: say(name) }), onclick: step(1) }, "+"));
    };
    const stages = h("div", { class: "chips", role: "group", "aria-label": say("stage") }, ...STAGES.map((stage) => h("button", {
      type: "button", "aria-pressed": String(draft.stage === stage),
      onclick: () => this.#act(() => this.field.note({ stage: draft.stage === stage ? "" : stage })) }, say(`stage_${stage}`))));
    return h("div", { id: "details" }, number("count"), number("leaves"), stages,
      h("div", { class: "pair" },
        h("button", { type: "button", id: "cancel", onclick: () => this.#act(() => this.field.note({ open: false })) }, say("cancel")),
        h("button", { type: "button", class: "found", id: "save", onclick: () => this.#tell("found", [60, 40, 60]) }, say("save_found"))));
  }

  /** Photo, note, undo, another plant. */
  #others() {
    const { field } = this, { draft } = field;
    const input = h("input", { type: "file", accept: "image/*", capture: "environment", id: "camera", class: "hidden", tabindex: "-1", "aria-hidden": "true",
      onchange: () => this.#photo(input.files[0]) });
    const small = (name, act, more = {}) => h("button", { type: "button", id: name, onclick: act, ...more }, say(name));
    const last = field.lastRecord(), offers = field.offered(), isOther = offers >= 0 && ![offers, twinOf(field.plot, offers)].includes(draft.plant);
    return h("div", { id: "others" }, input,
      draft.plant >= 0 && small("photo", () => input.click(), field.asked(draft.plant).length > 0 && !draft.photos ? { class: "main" } : {}),
      draft.plant >= 0 && small("note_button", () => this.#note(), { "aria-pressed": String(Boolean(draft.notes)) }),
      // beside a find that is not saved yet one would take it for that
      last && !draft.open && h("button", { type: "button", id: "undo", onclick: () => this.#act(() => this.field.undo(), 30).then(() => this.onTold?.()) }, `↶ ${say("undo")}`),
      isOther && small("here", () => this.#here()),
      small("other_plant", () => this.#other()),
      field.asked().length > 0 && h("button", { type: "button", id: "asked", onclick: () => this.#asked() }, `▣ ${say("asked", { n: field.asked().length })}`),
      field.offRoute && field.ahead.length > 0 && small("back_to_route", () => this.#act(() => field.goBack())),
      draft.photos > 0 && h("button", { type: "button", class: "tag", id: "photos", onclick: () => confirm(say("drop_photos")) && this.#act(() => field.dropPhotos()) }, say("photos", { n: draft.photos })),
      draft.notes ? h("p", { class: "noted" }, draft.notes) : null);
  }

  #back() { return this.field.hasNoRoute() ? [] : [h("button", { type: "button", class: "wide", onclick: () => this.planRest() }, say("plan_rest"))]; }

  async #photo(file) {
    if (!file) return;
    const photo = this.field.photoOf();
    this.#say(say("photo_comes"));
    let made;
    try { made = await scaled(file); } catch { return this.#say(say("no_picture"), true); }
    await this.#act(() => this.field.addPhoto(photo, made), 30);
    this.#draw();
  }

  /** Go where one stands now, which may be another plant than as the button was drawn; without a position the button goes. */
  #here() {
    const offers = this.field.offered();
    if (offers >= 0) this.#goTo(offers);
    else this.#draw();
  }

  /** Go to a plant; of one with two faces it is asked to which, and neither is taken for the other. */
  #goTo(plant) {
    const { field } = this, { plot } = field, twin = twinOf(plot, plant);
    const go = (one) => {
      if (field.plot?.digest !== plot.digest) return this.#draw(); // another window turned to another season meanwhile
      this.#act(() => field.goTo(one));
      this.map.look(one, true);
    };
    if (twin < 0) return go(plant);
    const place = say("place", { row: signOf(plot, plant), plant: plot.number[plant] });
    let rests = true; // a glove that bounces chooses none
    const tap = (act) => () => { if (!rests) { this.menu.close(); act?.(); } };
    // left and right as on the map, in every language; from the first where they are above each other
    const { x } = plot.drawn ?? plot, far = (a, b) => Math.round(100 * (x[a] - x[b]));
    const faces = [plant, twin].sort((a, b) => far(a, b) || plot.face[a] - plot.face[b]);
    const head = h("h2", { tabindex: "-1", autofocus: true }, place); // a key that is held presses no button
    const choice = h("div", { class: "pair", id: "faces", dir: "ltr", "data-resting": true, role: "group", "aria-labelledby": "which" }, ...faces.map((one) => h("button", {
      type: "button", class: "face", "data-plant": one, onclick: tap(() => go(one)) }, `${plot.face[one]} ${arrowOf(plot, one)}`)));
    setTimeout(() => { rests = false; choice.removeAttribute("data-resting"); }, REST_MS);
    this.#show(h("div", {}, head, h("p", { id: "which" }, say("which_face"), plot.drawn && ` ${say("as_on_map")}`), choice,
      h("button", { type: "button", class: "wide", onclick: tap() }, say("cancel"))), place, "face");
    head.focus();
  }

  /** The photos asked for: a button leads to each. */
  #asked() {
    const { field } = this;
    const lead = (one) => h("button", { type: "button", class: "wide", "data-plant": one.plant, onclick: () => {
      this.menu.close();
      this.#act(() => field.goTo(one.plant));
      this.map.look(one.plant, true);
    } }, `${placeOf(field.plot, one.plant)}${one.note ? `: ${own(one.note)}` : ""}`);
    const title = say("asked", { n: field.asked().length });
    this.#show(h("div", {}, h("h2", {}, title), ...field.asked().map(lead),
      h("button", { type: "button", class: "wide main", onclick: () => this.menu.close() }, say("close"))), title, "asked");
  }

  #note() {
    const text = h("textarea", { id: "notes", maxlength: "1990", rows: "4", "aria-label": say("note_button") });
    text.value = this.field.draft.notes ?? "";
    this.#ask(say("note_button"), text, () => this.#act(() => this.field.note({ notes: text.value.trim() })));
    text.focus();
  }

  #other() {
    const { plot } = this.field, numeric = { type: "number", inputmode: "numeric", min: "0" };
    const field = (name, kind = numeric) => h("input", { ...kind, id: `to_${name}`, required: true });
    const row = field("row", hasNames(plot) ? { type: "text", autocapitalize: "off" } : numeric), plant = field("plant");
    this.#ask(say("other_plant"), h("div", { class: "pair" }, h("label", {}, say("row"), row), h("label", {}, say("plant"), plant)), (event) => {
      const rows = rowsCalled(plot, row.value), found = rows.length === 1 ? plantAt(plot, rows[0], Number(plant.value)) : -1;
      if (rows.length > 1) this.#say(say("several_rows", { row: row.value }), true);
      else if (found < 0) this.#say(say("no_such_plant"), true);
      else {
        event.preventDefault(); // the face may be asked in the same dialog
        this.menu.close();
        this.#goTo(found);
      }
    });
    row.focus();
  }

  #ask(title, inner, done) {
    const form = h("form", { method: "dialog", onsubmit: done }, h("h2", {}, title), inner,
      h("div", { class: "pair" }, h("button", { type: "button", onclick: () => this.menu.close() }, say("cancel")), h("button", { class: "main", id: "ok" }, say("ok"))));
    this.#show(form, title, "form");
  }

  #show(inner, title, of) {
    this.menu.dataset.of = of;
    this.menu.setAttribute("aria-label", title);
    this.menu.replaceChildren(inner);
    if (!this.menu.open) this.menu.showModal();
  }

  // -- menu

  #openMenu() {
    const { field, choices } = this;
    const act = (name, work) => h("button", { type: "button", class: "wide", id: name, onclick: work }, say(name));
    const pick = (name, options) => h("fieldset", {}, h("legend", {}, say(name)), ...options.map(([value, text]) => h("button", {
      type: "button", lang: name === "language" ? value : null, "aria-pressed": String(choices[name] === value), onclick: () => this.choose({ [name]: value }) }, text)));
    // what could not even be read is no sentence for a person
    const why = (one) => (one.state === "refused" ? say("refused") : own(one.problem));
    const where = (one) => (one.season === field.season && one.plant >= 0 && field.plot
      ? `${placeOf(field.plot, one.plant)}: ` : "");
    const part = field.day?.rows && shownEnds(field.plot, field.day.rows);
    const refused = this.left.refused.map((one) => h("li", {}, `${where(one)}${why(one)}`));
    const inner = h("div", {}, h("h2", {}, field.day ? `${own(field.day.scout)}, ${own(dayOf(field.day.day))}` : "fieldmon"),
      field.day && h("p", {}, say("ahead_takes", { minutes: Math.round(field.secondsAhead() / 60) })),
      part && h("p", {}, say("your_rows", { low: part[0], high: part[1] })),
      ...this.#closed(),
      ...this.#leftOut(),
      // it has not everything where it did not take something, or not any more
      ...this.#takenBack("taken_back_too"),
      !((refused.length || this.stranded.size || field.takenBack().length) && this.state === "sent") && h("p", { class: this.state === "ended" ? "bad" : "" }, say(`state_${this.state}`)),
      ...[...this.stranded].map(([who, n]) => h("p", { class: "bad" }, say("stranded", { n, who }))),
      refused.length ? h("ul", { class: "bad" }, ...refused) : null,
      field.access && act("load_day", () => this.load()),
      field.day && !field.hasNoRoute() && act("plan_rest", () => this.planRest()),
      refused.length ? act("send_again", () => this.store.again().then(() => this.onTold?.())) : null,
      this.left.records + this.left.photos + refused.length > 0 && act("save_file", () => this.#saveFile()),
      field.seasons.length > 1 && h("fieldset", {}, h("legend", {}, say("plots")), ...field.seasons.map((one) => h("button", {
        type: "button", class: "season", "aria-pressed": String(one === field.season), onclick: () => this.#turnTo(one) }, own(one)))),
      pick("hand", [["left", say("left")], ["right", say("right")]]),
      pick("theme", [["auto", say("auto")], ["sun", say("sun")], ["dark", say("dark")]]),
      pick("language", Object.entries(LANGUAGES)),
      h("p", { class: "small" }, this.persisted ? say("stays") : say("may_be_cleared")),
      h("button", { type: "button", class: "wide main", id: "close", onclick: () => this.menu.close() }, say("close")));
    this.#show(inner, say("menu"), "menu");
  }

  load() { return this.#network(() => this.field.load()); }

  planRest() { return this.#network(() => this.field.planRest()); }

  async #turnTo(season) {
    this.menu.close();
    await this.#act(() => this.field.turnTo(season));
    await this.refresh();
    this.#look();
    if (this.field.day) this.onTold?.();
    else await this.load();
  }

  #look() {
    if (!this.field.day) return;
    this.map.fit();
    if (this.field.plant >= 0) this.map.look(this.field.plant);
  }

  async #network(work) {
    if (this.menu.open) this.menu.close();
    const { season } = this.field;
    this.#say(say("loading"));
    let why = "";
    try { await work(); } catch (error) {
      const known = error instanceof KeyEnded ? "state_ended" : error instanceof Held ? "state_held" : error instanceof NotNow ? "no_network" : null;
      why = known ? say(known) : error.message;
    }
    if (this.field.season !== season) return; // it is of what is not seen any more
    this.#say(why, why !== "");
    await this.refresh();
    this.#look();
    this.onStep?.();
    this.onTold?.();
  }

  async #saveFile() {
    const text = JSON.stringify(await this.store.unsent(this.field.time.said()));
    const link = h("a", { href: URL.createObjectURL(new Blob([text], { type: "application/json" })), download: `fieldmon-${this.field.season}-${Date.now()}.json` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  }
}
