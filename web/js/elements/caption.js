// What one sees in the picture, and why.

import { html, nothing } from "../../vendor/lit.js";
import { normalise } from "../angle.js";
import { azimuth, walkOff } from "../optics.js";
import { Piece } from "./piece.js";

export class Caption extends Piece {
  #mineral(request) {
    return this.studio.minerals.find((m) => m.id === request.parameters.mineral);
  }

  #n(value) {
    return this.speech.number(value, 3);
  }

  /** The numbers of this very block, once its manifest is there. */
  #numbers(scene, name) {
    if (!scene?.n_o) return nothing;
    const thick = scene.z1_mm - scene.z0_mm;
    const { tangent, degrees, tilt } = walkOff(scene.n_o, scene.n_e, scene.optic_axis);
    const shift = tangent * thick;
    const values = {
      mineral: name,
      no: this.#n(scene.n_o),
      ne: this.#n(scene.n_e),
      tilt: this.angle(tilt, 0, 2),
      walkoff: this.angle(degrees, 1, 1),
      thick: this.speech.number(thick, 0, 2),
      shift: this.speech.number(shift, 2),
    };
    return html`<p class="numbers">${this.say(shift < 0.005 ? "caption.together" : "caption.numbers", values)}</p>`;
  }

  #analyser(scene, degrees) {
    if (typeof degrees !== "number") return nothing;
    const axis = scene?.optic_axis;
    const base = { angle: this.angle(degrees, 0) };
    if (!axis || Math.hypot(axis[0], axis[1]) < 1e-6) return html`<p>${this.say("caption.analyser", base)}</p>`;
    // The extraordinary image vibrates in the plane of the optic axis and the vertical, the ordinary across it.
    const ordinary = normalise(degrees - azimuth(axis)) % 180;
    const extraordinary = (ordinary + 90) % 180;
    const pair = (a) => `${this.angle(a, 0)} ${this.say("caption.and")} ${this.angle(a + 180, 0)}`;
    return html`<p>
      ${this.say("caption.analyser", base)} ${this.say("caption.dark", { o: pair(ordinary), e: pair(extraordinary) })}
    </p>`;
  }

  render() {
    const { film, scene } = this.studio;
    if (!film) return nothing;
    const mineral = this.#mineral(film.request);
    const name = this.speech.pick(mineral?.names, film.request.parameters.mineral ?? "");
    const lower = name.toLocaleLowerCase(this.speech.language);
    const kind = mineral?.optical_class ?? "uniaxial";
    const key = `caption.${kind}`;
    return html`<section class="caption" aria-labelledby="caption-title">
      <h2 id="caption-title">${this.say("caption.title")}</h2>
      <p>
        ${this.speech.has(key) ? this.say(key, { mineral: lower }) : this.speech.pick(this.studio.demonstration.summary)}
      </p>
      ${mineral?.quality.colour === "estimated" ? html`<p>${this.say("quality.colour.estimated")}</p>` : nothing}
      ${kind === "uniaxial" ? this.#numbers(scene, name) : nothing}
      ${kind === "isotropic" && scene?.n ? html`<p class="numbers">${this.say("caption.index", { mineral: name, n: this.#n(scene.n) })}</p>` : nothing}
      ${kind === "uniaxial" ? this.#analyser(scene, film.request.parameters.analyser_deg) : nothing}
    </section>`;
  }
}

customElements.define("isogyre-caption", Caption);
