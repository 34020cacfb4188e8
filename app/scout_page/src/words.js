// The page in the scout's language; texts come from the app's catalogues.

export const LANGUAGES = { en: "English", he: "עברית", ar: "العربية", es: "Español" };
const RIGHT_TO_LEFT = ["he", "ar"];

let words = {};

export async function speak(language) {
  const chosen = LANGUAGES[language] ? language : "en";
  const answer = await fetch(`words/${chosen}.json`);
  words = await answer.json();
  document.documentElement.lang = chosen;
  document.documentElement.dir = RIGHT_TO_LEFT.includes(chosen) ? "rtl" : "ltr";
  return chosen;
}

/** A text, its blanks filled; words of people keep to their own direction. */
export function say(name, values = {}) {
  return (words[name] ?? name).replace(/\{(\w+)\}/g, (_, blank) => own(values[blank] ?? ""));
}

/** What is put into a text, so that its script changes no other's order. */
export const own = (value) => (typeof value === "string" && /\p{L}/u.test(value) ? `\u2068${value}\u2069` : value);

/** The language of the phone, where the page speaks it. */
export const phones = () => (navigator.languages ?? []).map((one) => one.slice(0, 2)).find((one) => LANGUAGES[one]) ?? "en";
