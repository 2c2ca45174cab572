// The chosen mineral in one line: formula, system, optical class and sign.

import { html, nothing } from "../../vendor/lit.js";
import { Piece } from "./piece.js";

const SUBSCRIPTS = "₀₁₂₃₄₅₆₇₈₉";

/** CaCO3 -> CaCO₃; a number that begins the formula or follows a space or dot counts molecules and stays. */
export function formulaText(formula) {
  return formula.replace(/(?<=[\p{L})\]])\d+/gu, (digits) => [...digits].map((d) => SUBSCRIPTS[d]).join(""));
}

export class Facts extends Piece {
  #phrase(prefix, name) {
    const key = `${prefix}.${name}`;
    return this.speech.has(key) ? this.say(key) : name;
  }

  #sign(mineral) {
    return mineral.optic_sign ? this.#phrase("sign", mineral.optic_sign) : null;
  }

  render() {
    const mineral = this.studio.minerals.find((m) => m.id === this.studio.values.mineral);
    if (!mineral) return nothing;
    const parts = [
      mineral.formula ? formulaText(mineral.formula) : null,
      mineral.system ? this.#phrase("system", mineral.system) : null,
      mineral.optical_class ? [this.#phrase("optical", mineral.optical_class), this.#sign(mineral)].filter(Boolean).join(" ") : null,
    ];
    return html`<p class="facts">${parts.filter(Boolean).join(" · ")}</p>`;
  }
}

customElements.define("isogyre-facts", Facts);
