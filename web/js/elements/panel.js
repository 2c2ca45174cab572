// The controls: what is in the scene and how it is to be drawn.

import { html, nothing } from "../../vendor/lit.js";
import { Problem } from "../problem.js";
import { QUALITIES } from "../request.js";
import { Piece } from "./piece.js";
import "./action.js";
import "./analyser.js";
import "./facts.js";
import "./field.js";
import "./trouble.js";

const SIDE = { least: 16, most: 2048 };
const COUNT = { least: 1, most: 360 };

/** The page's own fields, beside the demonstration's parameters, in the same form. */
const PICTURE = {
  quality: { kind: "choice", choices: QUALITIES, limits: [{}] },
  size: { kind: "numbers", limits: [SIDE, SIDE], unit: "px" },
  frames: { kind: "integer", limits: [COUNT] },
  seed: { kind: "integer", limits: [{}] },
};

export class Panel extends Piece {
  #shownProblem = null;

  #faults(pointer) {
    const { problem } = this.studio;
    return problem instanceof Problem ? problem.at(pointer) : [];
  }

  #field(field) {
    const { studio } = this;
    if (field.kind === "analyser") return nothing;
    return html`<isogyre-field
        .field=${field}
        .value=${studio.values[field.name]}
        .faults=${this.#faults(`/parameters/${field.name}`)}
        .minerals=${studio.minerals}
        .speech=${this.speech}
        @told=${(event) => studio.set(field.name, event.detail)}
      ></isogyre-field>
      ${field.kind === "mineral" ? html`<isogyre-facts .studio=${studio} .speech=${this.speech}></isogyre-facts>` : nothing}`;
  }

  #picture(name) {
    const { studio } = this;
    const label = { [this.speech.language]: this.say(`picture.${name}`) };
    const field = { name, label, unit: "", description: "", nullable: false, advanced: true, ...PICTURE[name] };
    return html`<isogyre-field
      .field=${field}
      .value=${studio.settings[name]}
      .faults=${this.#faults(`/${name}`)}
      .minerals=${[]}
      .speech=${this.speech}
      @told=${(event) => studio.setPicture(name, event.detail)}
    ></isogyre-field>`;
  }

  /** The advanced parameters, under the names of their groups. */
  #more(fields) {
    const groups = new Map();
    for (const field of fields) {
      const name = this.speech.pick(field.group);
      groups.set(name, [...(groups.get(name) ?? []), field]);
    }
    return [...groups].map(
      ([name, members]) =>
        html`<div class="group" role="group" aria-label=${name || nothing}>
          ${name ? html`<h3>${name}</h3>` : nothing} ${members.map((f) => this.#field(f))}
        </div>`,
    );
  }

  #demonstration() {
    const { studio } = this;
    if (studio.demonstrations.length < 2) return html`<h2>${this.speech.pick(studio.demonstration?.title)}</h2>`;
    return html`<label class="field" for="demonstration"
      ><span>${this.say("panel.demonstration")}</span>
      <select id="demonstration" @change=${(e) => studio.choose(e.target.value)}>
        ${studio.demonstrations.map((d) => html`<option value=${d.name} ?selected=${d === studio.demonstration}>${this.speech.pick(d.title, d.name)}</option>`)}
      </select></label
    >`;
  }

  render() {
    const { studio } = this;
    const { fields } = studio;
    const advanced = fields.filter((f) => f.advanced);
    const hidden =
      advanced.some((f) => this.#faults(`/parameters/${f.name}`).length) || this.#faults("/seed").length > 0;
    return html`<form
      class="panel"
      novalidate
      aria-label=${this.say("panel.title")}
      @submit=${(event) => {
        event.preventDefault();
        studio.press();
      }}
    >
      <div class="sheet">
        <div class="group">
          ${this.#demonstration()}
          <p class="summary">${this.speech.pick(studio.demonstration?.summary)}</p>
          ${fields.filter((f) => !f.advanced).map((f) => this.#field(f))}
        </div>
        ${
          fields.some((f) => f.kind === "analyser")
            ? html`<div class="group">
                <isogyre-analyser
                  .studio=${studio}
                  .speech=${this.speech}
                  .faults=${this.#faults("/parameters/analyser_deg")}
                ></isogyre-analyser>
              </div>`
            : nothing
        }
        <div class="group" role="group" aria-label=${this.say("panel.picture")}>
          ${this.#picture("quality")} ${this.#picture("size")} ${this.#picture("frames")}
        </div>
        <details class="group" ?open=${hidden}>
          <summary>${this.say("panel.more")}</summary>
          ${this.#more(advanced)}
          <div class="group" role="group" aria-label=${this.say("panel.sampling")}>
            <h3>${this.say("panel.sampling")}</h3>
            ${this.#picture("seed")}
          </div>
        </details>
      </div>
      <div class="foot">
        <isogyre-trouble .studio=${studio} .speech=${this.speech}></isogyre-trouble>
        <isogyre-action .studio=${studio} .speech=${this.speech}></isogyre-action>
      </div>
    </form>`;
  }

  async updated() {
    const { problem } = this.studio;
    if (problem === this.#shownProblem) return;
    this.#shownProblem = problem;
    if (!problem) return;
    // To the first control that the problem is about: it may be out of sight.
    await Promise.all([...this.querySelectorAll("isogyre-field, isogyre-analyser")].map((e) => e.updateComplete));
    this.querySelector('[aria-invalid="true"]')?.focus();
  }
}

customElements.define("isogyre-panel", Panel);
