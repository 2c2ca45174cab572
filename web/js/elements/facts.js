// The chosen mineral: formula, system, optical class and sign, indices, how far its numbers can be trusted, and where
// they come from.

import { html, nothing } from "../../vendor/lit.js";
import { Piece } from "./piece.js";

const SUBSCRIPTS = "₀₁₂₃₄₅₆₇₈₉";

/** CaCO3 -> CaCO₃; a number that begins the formula or follows a space or dot counts molecules and stays. */
export function formulaText(formula) {
  return formula.replace(/(?<=[\p{L})\]])\d+/gu, (digits) => [...digits].map((d) => SUBSCRIPTS[d]).join(""));
}

/**
 * The sources of an entry's numbers: every part of it that names a source, under the key it stands at.
 *
 * @returns {{part: string, status: string, source: {citation: string, doi: string | null}}[]}
 */
export function sourcesOf(entry) {
  const rows = new Map();
  for (const [part, value] of Object.entries(entry)) {
    if (part === "sources" || value === null || typeof value !== "object") continue;
    for (const node of nodes(value)) {
      const source = entry.sources[node.source];
      if (source) rows.set(`${part} ${node.source} ${node.status}`, { part, status: node.status, source });
    }
  }
  return [...rows.values()];
}

function* nodes(value) {
  if (value === null || typeof value !== "object") return;
  if (typeof value.source === "string") yield value;
  for (const below of Object.values(value)) yield* nodes(below);
}

/** Principal indices by the names that mineralogists give them: n; nₒ, nₑ; or nα, nβ, nγ in rising order. */
export function namedIndices(indices) {
  const list = Object.entries(indices);
  if (list.length < 3) return list.map(([axis, n]) => [{ o: "nₒ", e: "nₑ", n: "n" }[axis], n]);
  return list.map(([, n]) => n).sort((a, b) => a - b).map((n, place) => [["nα", "nβ", "nγ"][place], n]);
}

export class Facts extends Piece {
  #phrase(prefix, name) {
    const key = `${prefix}.${name}`;
    return this.speech.has(key) ? this.say(key) : name;
  }

  #sign(mineral) {
    return mineral.optic_sign ? this.#phrase("sign", mineral.optic_sign) : null;
  }

  #indices({ indices, two_v_deg: twoV }) {
    const { wavelength_nm: wavelength, ...values } = indices;
    const list = namedIndices(values).map(([name, n]) => `${name} = ${this.speech.number(n, 4)}`);
    if (twoV !== null) list.push(`2V = ${this.angle(twoV, 0, 1)}`);
    return this.say("facts.indices", { list: list.join(", "), wavelength: this.speech.number(wavelength, 0, 1) });
  }

  #quality({ dispersion, colour }) {
    const lines = [`colour.${colour}`, `dispersion.${dispersion}`].map((key) => `quality.${key}`);
    return lines.filter((key) => this.speech.has(key)).map((key) => this.say(key)).join(" ");
  }

  #source({ part, status, source }) {
    return html`<li>
      ${this.#phrase("part", part)}${status === "published" ? nothing : html` (${this.#phrase("status", status)})`}:
      <span lang="en">${source.citation}${source.doi ? ` doi:${source.doi}` : ""}</span>
    </li>`;
  }

  render() {
    const mineral = this.studio.minerals.find((m) => m.id === this.studio.values.mineral);
    if (!mineral) return nothing;
    const entry = this.studio.entries.get(mineral.id);
    const parts = [
      formulaText(mineral.formula),
      this.#phrase("system", mineral.system),
      [this.#phrase("optical", mineral.optical_class), this.#sign(mineral)].filter(Boolean).join(" "),
    ];
    return html`<div class="facts">
      <p>${parts.join(" · ")}</p>
      <p>${this.#indices(mineral)}</p>
      <p class="quality">${this.#quality(mineral.quality)}</p>
      <details ?hidden=${!entry}>
        <summary>${this.say("facts.sources")}</summary>
        <ul>
          ${entry ? sourcesOf(entry).map((row) => this.#source(row)) : nothing}
        </ul>
      </details>
    </div>`;
  }
}

customElements.define("isogyre-facts", Facts);
