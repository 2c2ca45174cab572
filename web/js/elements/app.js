// The page as a whole.

import { html } from "../../vendor/lit.js";
import { remember } from "../speech.js";
import { Piece } from "./piece.js";
import "./caption.js";
import "./downloads.js";
import "./languages.js";
import "./panel.js";
import "./stage.js";
import "./transport.js";

export class App extends Piece {
  /** @param {Map<string, import("../speech.js").Speech>} speeches */
  speak(language, speeches = this.speeches) {
    this.speeches = speeches;
    this.speech = speeches.get(language);
    document.documentElement.lang = language;
    document.title = this.say("title");
  }

  #spoken(event) {
    remember(event.detail);
    this.speak(event.detail);
  }

  render() {
    const { studio, speech } = this;
    return html`<a class="skip" href="#stage" @click=${this.#skip}>${this.say("skip")}</a>
      <header class="masthead">
        <p class="name">
          <svg viewBox="-12 -12 24 24" aria-hidden="true">
            <circle r="11" class="field-of-view"></circle>
            <circle r="4" class="ring"></circle>
            <circle r="7.5" class="ring"></circle>
            <path
              class="cross"
              d="M0 -11C1 -4 1 -1 0 0C-1 -1 -1 -4 0 -11ZM0 11C1 4 1 1 0 0C-1 1 -1 4 0 11ZM-11 0C-4 1 -1 1 0 0C-1 -1 -4 -1 -11 0ZM11 0C4 1 1 1 0 0C1 -1 4 -1 11 0Z"
            ></path>
          </svg>
          <span>Isogyre</span>
        </p>
        <p class="motto">${this.say("motto")}</p>
        <isogyre-languages .speech=${speech} @speak=${this.#spoken}></isogyre-languages>
      </header>
      <main>
        <h1 class="visually-hidden">Isogyre: ${speech.pick(studio.demonstration?.title)}</h1>
        <div class="theatre" id="stage" tabindex="-1">
          <isogyre-stage .studio=${studio} .speech=${speech}></isogyre-stage>
          <isogyre-transport .studio=${studio} .speech=${speech}></isogyre-transport>
          <isogyre-caption .studio=${studio} .speech=${speech}></isogyre-caption>
          <isogyre-downloads .studio=${studio} .speech=${speech}></isogyre-downloads>
        </div>
        <isogyre-panel .studio=${studio} .speech=${speech}></isogyre-panel>
      </main>`;
  }

  #skip(event) {
    // The hash is the view's own; the stage is reached without it.
    event.preventDefault();
    this.querySelector("#stage").focus();
  }
}

customElements.define("isogyre-app", App);
