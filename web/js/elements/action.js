// Render and cancel, and how far it is.

import { html, nothing } from "../../vendor/lit.js";
import { Piece } from "./piece.js";

export class Action extends Piece {
  #moment = "";
  #said = "";

  #left(film, share) {
    const spent = (performance.now() - film.began) / 1000;
    // The first moments say nothing about the rest.
    if (spent < 2 || share < 0.05) return null;
    return Math.max(1, Math.round((spent * (1 - share)) / share));
  }

  #duration(seconds) {
    return seconds < 90
      ? this.say("time.seconds", { s: this.speech.number(seconds, 0, seconds < 10 ? 1 : 0) })
      : this.say("time.minutes", { m: this.speech.number(Math.round(seconds / 60)) });
  }

  #words() {
    const { studio } = this;
    const { film } = studio;
    if (studio.asking || !film) return studio.asking ? this.say("progress.asking") : "";
    const done = film.loaded;
    const all = film.count;
    const values = { done, all, quality: this.say(`choice.quality.${film.request.quality}`) };
    switch (film.status) {
      case "accepted":
        return this.say("progress.accepted");
      case "running": {
        const left = this.#left(film, film.job.progress.fraction);
        return left === null
          ? this.say("progress.running", values)
          : this.say("progress.left", { ...values, left: this.#duration(left) });
      }
      case "dismissed":
        return this.say("progress.dismissed", values);
      case "failed":
        return this.say("progress.failed", values);
      default:
        return this.say("progress.successful", { ...values, took: this.#duration(film.lasted ?? 0) });
    }
  }

  /** What a listener is told: the beginning, the quarters, the end; not every frame. */
  #spoken(words) {
    const { film, asking } = this.studio;
    const quarter = film && film.status === "running" ? Math.floor(film.job.progress.fraction * 4) : "end";
    const now = `${asking}/${film?.job.id}/${film?.status}/${quarter}/${this.speech.language}`;
    if (now !== this.#moment) {
      this.#moment = now;
      this.#said = words;
    }
    return this.#said;
  }

  render() {
    const { studio } = this;
    const { film, running } = studio;
    const words = this.#words();
    const share = film?.job.progress.fraction ?? 0;
    const estimate = studio.view?.state === "exact" ? studio.view.picture : null;
    return html`<div class="action">
      <div class="pair">
        <button type="submit" class="render" ?data-news=${studio.differs || !studio.film}>
          ${this.say("action.render")}
        </button>
        <button type="button" class="cancel" ?disabled=${!running} @click=${() => studio.cancel()}>
          ${this.say("action.cancel")}
        </button>
      </div>
      <progress max="1" .value=${studio.asking ? 0 : share} aria-label=${this.say("progress.title")}></progress>
      <p class="words" data-status=${studio.asking ? "asking" : (film?.status ?? "none")}>${words}</p>
      <p class="words estimate">
        ${
          estimate
            ? html`${this.say(`choice.quality.${estimate.quality}`)}${estimate.error === null ? nothing : html` · <abbr title=${this.say("estimate.help")}>${this.say("estimate.error", { error: this.speech.number(estimate.error, 3, 4) })}</abbr>`}`
            : nothing
        }
      </p>
      <p class="visually-hidden" role="status" aria-live="polite">${this.#spoken(words)}</p>
    </div>`;
  }
}

customElements.define("isogyre-action", Action);
