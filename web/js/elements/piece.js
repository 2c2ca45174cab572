// What every element of the page has: the studio it looks at and the language it speaks. No shadow trees: one style
// sheet, and labels and descriptions that may point anywhere in the page.

import { LitElement } from "../../vendor/lit.js";

export class Piece extends LitElement {
  static properties = { studio: { attribute: false }, speech: { attribute: false } };

  #look = () => this.requestUpdate();
  #watched = null;

  createRenderRoot() {
    return this;
  }

  /** Nothing to show before there is a studio and a language. */
  shouldUpdate() {
    return Boolean(this.studio && this.speech);
  }

  willUpdate() {
    if (this.#watched === this.studio) return;
    this.#watched?.removeEventListener("change", this.#look);
    this.#watched = this.studio ?? null;
    this.#watched?.addEventListener("change", this.#look);
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#watched?.removeEventListener("change", this.#look);
    this.#watched = null;
  }

  /** Shorthand for the phrase of a key. */
  say(key, values) {
    return this.speech.say(key, values);
  }

  /** An angle as this language writes it, with its sign: 7.5°. */
  angle(degrees, least = 0, most = 4) {
    return `${this.speech.number(degrees, least, most)}°`;
  }
}
