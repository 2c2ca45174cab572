// The page's two languages.

const KEPT = "isogyre.language";
export const LANGUAGES = ["en", "ru"];

/** One language: its words, its numbers. Immutable; another language is another Speech. */
export class Speech {
  #words;

  constructor(language, words) {
    this.language = language;
    this.#words = words;
  }

  /** The phrase of a key, with {name} replaced by the values given. A key without a phrase is a defect and throws. */
  say(key, values = {}) {
    const phrase = this.#words[key];
    if (phrase === undefined) throw new Error(`no ${this.language} phrase for ${key}`);
    return phrase.replace(/\{(\w+)\}/g, (_, name) => values[name] ?? `{${name}}`);
  }

  has(key) {
    return this.#words[key] !== undefined;
  }

  /** The text of this language in {en, ru}; English where a language is wanting. */
  pick(texts, otherwise = "") {
    return texts?.[this.language] ?? texts?.en ?? otherwise;
  }

  /** A number as this language writes it. */
  number(value, least = 0, most = least) {
    return new Intl.NumberFormat(this.language, {
      minimumFractionDigits: least,
      maximumFractionDigits: most,
      useGrouping: false,
    }).format(value);
  }

  /** A unit as this language writes it: mm → мм; what is not in the list stays as it is. */
  unit(name) {
    const key = `unit.${name}`;
    return this.has(key) ? this.say(key) : (name ?? "");
  }
}

/** Both languages, from i18n/. */
export async function speeches(base) {
  const load = async (language) => {
    const response = await fetch(new URL(`i18n/${language}.json`, base));
    if (!response.ok) throw new Error(`${response.url}: ${response.status}`);
    return [language, new Speech(language, await response.json())];
  };
  return new Map(await Promise.all(LANGUAGES.map(load)));
}

/** The language chosen before, else the browser's, else English. */
export function firstLanguage() {
  const kept = remembered();
  if (LANGUAGES.includes(kept)) return kept;
  const wished = navigator.languages?.length ? navigator.languages : [navigator.language ?? ""];
  for (const tag of wished) {
    const language = tag.slice(0, 2).toLowerCase();
    if (LANGUAGES.includes(language)) return language;
  }
  return "en";
}

export function remember(language) {
  try {
    localStorage.setItem(KEPT, language);
  } catch {
    // A browser that keeps nothing: the language holds for this visit.
  }
}

function remembered() {
  try {
    return localStorage.getItem(KEPT);
  } catch {
    return null;
  }
}
