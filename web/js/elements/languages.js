// English or Russian, at once.

import { LitElement, html } from "../../vendor/lit.js";

const NAMES = { en: "English", ru: "Русский" };

export class Languages extends LitElement {
  static properties = { speech: { attribute: false } };

  createRenderRoot() {
    return this;
  }

  render() {
    return html`<div class="languages" role="group" aria-label=${this.speech.say("language.title")}>
      ${Object.entries(NAMES).map(
        ([code, name]) =>
          html`<button
            type="button"
            lang=${code}
            aria-pressed=${code === this.speech.language}
            @click=${() => this.dispatchEvent(new CustomEvent("speak", { detail: code }))}
          >
            ${name}
          </button>`,
      )}
    </div>`;
  }
}

customElements.define("isogyre-languages", Languages);
