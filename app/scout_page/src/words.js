// The page in the scout's language; texts come from the app's catalogues.

export const LANGUAGES = { en: "English", he: "עברית", ar: "العربية", es: "Español" };
const RIGHT_TO_LEFT = ["he", "ar"];

let words = {}, spoken = "en";

export async function speak(language) {
  const chosen = LANGUAGES[language] ? language : "en";
  const answer = await fetch(`words/${chosen}.json`);
  words = await answer.json();
  spoken = chosen;
  document.documentElement.lang = chosen;
  document.documentElement.dir = RIGHT_TO_LEFT.includes(chosen) ? "rtl" : "ltr";
  return chosen;
}

/** A text, its blanks filled; words of people keep to their own direction. `{n:plant|plants}` chooses words by a number. */
export function say(name, values = {}) {
  const filled = (_, blank, one, many) => (one === undefined ? own(values[blank] ?? "") : Number(values[blank]) === 1 ? one : many);
  return (words[name] ?? name).replace(/\{(\w+)(?::([^|{}]*)\|([^|{}]*))?\}/g, filled);
}

/** A chance in thousandths, in words: none is said to be nothing or all. */
export function chanceSaid(n) {
  if (n < 1) return say("chance_least");
  return n < 995 ? say("chance", { n: (n / 10).toFixed(n < 100 ? 1 : 0) }) : say("chance_most");
}

/** What is put into a text, so that its script changes no other's order. */
export const own = (value) => (typeof value === "string" && /\p{L}/u.test(value) ? `\u2068${value}\u2069` : value);

/** A day as the app says it: short weekday, day and month, "Mon 16 Nov"; files have it as it comes, "2026-11-16". */
export function dayOf(iso, language = spoken) {
  const written = (parts) => new Intl.DateTimeFormat(language, { ...parts, timeZone: "UTC", calendar: "gregory", numberingSystem: "latn" }).format(new Date(iso));
  const [weekday, day, month] = [{ weekday: "short" }, { day: "numeric" }, { month: "short" }].map(written);
  if (language === "en") return `${weekday} ${day} ${month}`;
  // Hebrew names "day A" to "day F", and a sentence says "on day" itself
  return `${weekday.replace("יום ", "")} ${written({ day: "numeric", month: "short" })}`;
}

/** The language of the phone, where the page speaks it. */
export const phones = () => (navigator.languages ?? []).map((one) => one.slice(0, 2)).find((one) => LANGUAGES[one]) ?? "en";
