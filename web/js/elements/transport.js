// Turning the stage: by frame, by hand, by number, by itself.

import { html, nothing, svg } from "../../vendor/lit.js";
import { azimuth } from "../optics.js";
import { decimals, normalise } from "../angle.js";
import { PACES } from "../player.js";
import { stageFace } from "./faces.js";
import { BACK, ON, PAUSE, PLAY } from "./icons.js";
import { Piece } from "./piece.js";
import "./dial.js";

export class Transport extends Piece {
  #slide(event) {
    this.studio.pause();
    this.studio.turnNear(Number(event.target.value) + this.#first());
  }

  #first() {
    return this.studio.film?.angle(0) ?? 0;
  }

  #keys(event) {
    const moves = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };
    if (event.key in moves) this.studio.step(moves[event.key]);
    else if (event.key === "Home" || event.key === "End") this.studio.toEnd(event.key === "End");
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #exact(event) {
    event.preventDefault();
    const field = this.querySelector("#angle");
    const wanted = Number(field.value.replace(",", "."));
    if (field.value.trim() === "" || !Number.isFinite(wanted)) {
      field.value = this.#shown();
      return;
    }
    this.studio.pause();
    this.studio.turn(wanted);
    field.value = this.#shown();
  }

  #shown() {
    return this.speech.number(this.studio.angle, 0, 4);
  }

  #toggle() {
    if (this.studio.player.playing) this.studio.pause();
    else this.studio.play();
  }

  #pace(event) {
    this.studio.player.pace = Number(event.target.value);
    this.studio.changed();
  }

  #dial() {
    const { studio } = this;
    const axis = studio.scene?.optic_axis;
    const tilted = axis && Math.hypot(axis[0], axis[1]) > 1e-6;
    const face = stageFace({
      degrees: studio.angle,
      vertices: studio.scene?.vertices_mm,
      azimuth: tilted ? azimuth(axis) : null,
      analyser: studio.film?.request.parameters.analyser_deg ?? null,
    });
    return html`<isogyre-dial
      class="compass"
      title=${this.say("stage.compass")}
      .degrees=${studio.angle}
      .face=${face}
      .disabled=${!studio.film}
      @turn=${(event) => {
        studio.pause();
        studio.turnNear(event.detail);
      }}
    ></isogyre-dial>`;
  }

  /** Which frames are there: a thin row of cells under the slider. */
  #cells() {
    const { film } = this.studio;
    if (!film) return nothing;
    const gap = Math.min(0.12, film.count * 0.003);
    const cells = Array.from({ length: film.count }, (_, i) =>
      film.picture(i) ? svg`<rect x=${i + gap / 2} width=${1 - gap} height="1"></rect>` : nothing,
    );
    return html`<svg class="cells" viewBox="0 0 ${film.count} 1" preserveAspectRatio="none" aria-hidden="true">
      <rect class="ground" width=${film.count} height="1"></rect>
      ${cells}
    </svg>`;
  }

  render() {
    const { studio } = this;
    const { film } = studio;
    const step = 360 / (film?.count ?? 36);
    const last = 360 - step;
    const here = normalise(studio.angle - this.#first());
    const playing = studio.player.playing;
    const shown = this.angle(studio.angle, decimals(step));
    return html`<section class="transport" aria-label=${this.say("stage.controls")}>
      ${this.#dial()}
      <div class="scrub">
        <input
          id="turn"
          type="range"
          min="0"
          max=${last}
          step="any"
          .value=${String(Math.min(here, last))}
          ?disabled=${!film}
          aria-label=${this.say("stage.angle")}
          aria-valuetext=${shown}
          aria-keyshortcuts="ArrowLeft ArrowRight Home End Space"
          @input=${this.#slide}
          @keydown=${this.#keys}
        />
        ${this.#cells()}
      </div>
      <div class="buttons">
        <button
          type="button"
          class="round"
          @click=${() => studio.step(-1)}
          ?disabled=${!film}
          aria-label=${this.say("stage.back")}
          title=${this.say("stage.back")}
        >
          ${BACK}
        </button>
        <button
          type="button"
          class="round play"
          @click=${this.#toggle}
          ?disabled=${!film}
          aria-label=${this.say(playing ? "stage.pause" : "stage.play")}
          title=${this.say(playing ? "stage.pause" : "stage.play")}
        >
          ${playing ? PAUSE : PLAY}
        </button>
        <button
          type="button"
          class="round"
          @click=${() => studio.step(1)}
          ?disabled=${!film}
          aria-label=${this.say("stage.on")}
          title=${this.say("stage.on")}
        >
          ${ON}
        </button>
        <label class="pace"
          ><span>${this.say("stage.pace")}</span>
          <select @change=${this.#pace}>
            ${PACES.map((s) => html`<option value=${s} ?selected=${s === studio.player.pace}>${this.say("stage.seconds", { s })}</option>`)}
          </select></label
        >
      </div>
      <form class="exact" novalidate @submit=${this.#exact}>
        <label for="angle">${this.say("stage.angle")}</label>
        <span class="quantity"
          ><input
            id="angle"
            inputmode="decimal"
            autocomplete="off"
            .value=${this.#shown()}
            ?disabled=${!film}
            title=${this.say("stage.exact")}
            @focus=${() => studio.pause()}
            @change=${this.#exact}
          /><span>°</span></span
        >
      </form>
    </section>`;
  }
}

customElements.define("isogyre-transport", Transport);
