// The polarizer before the camera: out of the way, or at an angle. Letting it go renders anew.

import { html, nothing } from "../../vendor/lit.js";
import { analyserFace } from "./faces.js";
import { Piece } from "./piece.js";
import "./dial.js";

/** An angle of the analyser in [0, 180): it has no front and no back. */
const half = (degrees) => ((Math.round(degrees) % 180) + 180) % 180;

export class Analyser extends Piece {
  static properties = { ...Piece.properties, faults: { attribute: false }, moving: { state: true } };

  constructor() {
    super();
    this.faults = [];
    this.moving = null; // the angle while it is being turned
    this.last = 0; // where it stood before it was taken out
  }

  get #value() {
    return this.moving ?? this.studio.values.analyser_deg;
  }

  #settle(value) {
    this.moving = null;
    if (typeof value === "number") this.last = value;
    if (value !== this.studio.values.analyser_deg || this.faults.length) this.studio.analyse(value);
  }

  #typed(event) {
    const text = event.target.value.trim().replace(",", ".");
    const number = Number(text);
    // What is no number goes to the service as it stands; the problem it answers with is shown here.
    this.#settle(text !== "" && Number.isFinite(number) ? number : text);
  }

  render() {
    const value = this.#value;
    const inside = value !== null && value !== undefined;
    const degrees = typeof value === "number" ? value : this.last;
    return html`<fieldset class="analyser" ?data-in=${inside}>
      <legend class="visually-hidden">${this.say("analyser.title")}</legend>
      <label class="switch" title=${this.say("analyser.help")}
        ><input
          id="analyser-in"
          type="checkbox"
          role="switch"
          .checked=${inside}
          @change=${(e) => this.#settle(e.target.checked ? this.last : null)}
        /><span>${this.say("analyser.title")}</span></label
      >
      <isogyre-dial
        .degrees=${degrees}
        .face=${analyserFace(degrees)}
        .disabled=${!inside}
        @turn=${(e) => (this.moving = half(e.detail))}
        @settle=${() => this.moving !== null && this.#settle(this.moving)}
      ></isogyre-dial>
      <div class="turning">
        <input
          id="analyser-turn"
          type="range"
          min="0"
          max="180"
          step="1"
          .value=${String(degrees)}
          ?disabled=${!inside}
          aria-label=${this.say("analyser.angle")}
          aria-valuetext=${this.angle(degrees, 0)}
          @input=${(e) => (this.moving = Number(e.target.value))}
          @change=${(e) => this.#settle(Number(e.target.value))}
        />
        <span class="quantity"
          ><input
            id="field-analyser_deg"
            inputmode="decimal"
            autocomplete="off"
            aria-label=${this.say("analyser.angle")}
            aria-invalid=${this.faults.length ? "true" : nothing}
            aria-describedby=${this.faults.length ? "analyser-fault" : nothing}
            .value=${typeof value === "number" ? this.speech.number(value, 0, 4) : (value ?? "")}
            ?disabled=${!inside}
            @change=${this.#typed}
          /><span>°</span></span
        >
      </div>
      ${this.faults.length ? html`<p class="fault" id="analyser-fault">${this.faults.map((f) => html`<span lang="en">${f.detail}</span> `)}</p>` : nothing}
    </fieldset>`;
  }
}

customElements.define("isogyre-analyser", Analyser);
