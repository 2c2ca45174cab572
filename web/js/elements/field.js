// One parameter: its label, the control that its schema calls for, and what the service found wrong with it.

import { LitElement, html, nothing } from "../../vendor/lit.js";
import { read } from "../schema.js";

const AXES = ["x", "y", "z"];

export class Field extends LitElement {
  static properties = {
    field: { attribute: false },
    value: { attribute: false },
    faults: { attribute: false }, // [{pointer, detail}] of this field
    minerals: { attribute: false },
    speech: { attribute: false },
  };

  createRenderRoot() {
    return this;
  }

  #tell(value) {
    this.dispatchEvent(new CustomEvent("told", { detail: value }));
  }

  /** What is typed, as a value; what cannot be read goes to the service as it is and comes back as a problem. */
  #typed(event) {
    this.#tell(read(this.field, event.target.value));
  }

  #component(index, text) {
    const value = [...this.value];
    value[index] = read({ kind: "number" }, text);
    this.#tell(value);
  }

  #number(id, value, limits, label, tell) {
    return html`<input
      id=${id}
      inputmode="decimal"
      autocomplete="off"
      aria-label=${label ?? nothing}
      aria-invalid=${this.faults.length ? "true" : nothing}
      aria-describedby=${this.faults.length ? `${this.#id}-fault` : nothing}
      title=${this.#range(limits) || nothing}
      .value=${this.#shown(value)}
      @change=${tell}
    />`;
  }

  #shown(value) {
    if (value === null || value === undefined) return "";
    if (typeof value === "number") return this.speech.number(value, 0, 8);
    return typeof value === "string" ? value : JSON.stringify(value);
  }

  /** The permitted range in words, "" where there is none. */
  #range({ least, most } = {}) {
    const n = (value) => this.speech.number(value, 0, 6);
    const unit = this.speech.unit(this.field.unit);
    if (least !== undefined && most !== undefined)
      return this.speech.say("field.between", { least: n(least), most: n(most), unit });
    if (least !== undefined) return this.speech.say("field.least", { least: n(least), unit });
    return most === undefined ? "" : this.speech.say("field.most", { most: n(most), unit });
  }

  get #id() {
    return `field-${this.field.name}`;
  }

  get #label() {
    return this.speech.pick(this.field.label, this.field.name);
  }

  #mineralOptions() {
    const allowed = this.minerals.filter((m) => !this.field.classes || this.field.classes.includes(m.optical_class));
    const classes = [...new Set(allowed.map((m) => m.optical_class))].sort((a, b) => RANK.indexOf(a) - RANK.indexOf(b));
    const name = (m) => this.speech.pick(m.names, m.id);
    const known = allowed.some((m) => m.id === this.value);
    return html`${known ? nothing : html`<option value=${this.#shown(this.value)} selected>${this.#shown(this.value)}</option>`}
    ${classes.map(
      (c) =>
        html`<optgroup label=${this.speech.has(`class.${c}`) ? this.speech.say(`class.${c}`) : c}>
          ${allowed
            .filter((m) => m.optical_class === c)
            .sort((a, b) => name(a).localeCompare(name(b), this.speech.language))
            .map((m) => html`<option value=${m.id} ?selected=${m.id === this.value}>${name(m)}</option>`)}
        </optgroup>`,
    )}`;
  }

  #choiceOptions() {
    const known = this.field.choices.includes(this.value);
    const name = (choice) => {
      const key = `choice.${this.field.name}.${choice}`;
      return this.speech.has(key) ? this.speech.say(key) : String(choice);
    };
    return html`${known ? nothing : html`<option value=${this.#shown(this.value)} selected>${this.#shown(this.value)}</option>`}
    ${this.field.choices.map((c) => html`<option value=${c} ?selected=${c === this.value}>${name(c)}</option>`)}`;
  }

  #control() {
    const { field, value } = this;
    const faulty = this.faults.length > 0;
    const invalid = faulty ? "true" : nothing;
    const described = faulty ? `${this.#id}-fault` : nothing;
    switch (field.kind) {
      case "mineral":
      case "choice":
        return html`<select id=${this.#id} aria-invalid=${invalid} aria-describedby=${described} @change=${this.#typed}>
          ${field.kind === "mineral" ? this.#mineralOptions() : this.#choiceOptions()}
        </select>`;
      case "boolean":
        return html`<input
          id=${this.#id}
          type="checkbox"
          aria-invalid=${invalid}
          aria-describedby=${described}
          .checked=${value === true}
          @change=${(e) => this.#tell(e.target.checked)}
        />`;
      case "number":
      case "integer":
      case "analyser":
        return html`${this.#slider()}<span class="quantity"
            >${this.#number(this.#id, value, field.limits[0], null, this.#typed)}${this.#unit()}</span
          >`;
      case "numbers": {
        const parts = Array.isArray(value) ? value : field.limits.map(() => null);
        return html`<span class="quantity several"
          >${parts.map((part, i) => this.#number(i === 0 ? this.#id : `${this.#id}-${i}`, part, field.limits[i], `${this.#label}, ${AXES[i] ?? i + 1}`, (e) => this.#component(i, e.target.value)))}${this.#unit()}</span
        >`;
      }
      default:
        return html`<span class="quantity wide"
          ><input
            id=${this.#id}
            autocomplete="off"
            spellcheck="false"
            aria-invalid=${invalid}
            aria-describedby=${described}
            .value=${this.#shown(value)}
            @change=${this.#typed}
          />${this.#unit()}</span
        >`;
    }
  }

  #slider() {
    const { least, most } = this.field.limits[0];
    if (least === undefined || most === undefined || this.field.kind === "integer" || this.field.advanced)
      return nothing;
    return html`<input
      type="range"
      min=${least}
      max=${most}
      step=${(most - least) / 180}
      aria-label=${this.#label}
      .value=${String(this.value)}
      @input=${(e) => this.#tell(Number(Number(e.target.value).toFixed(4)))}
    />`;
  }

  #unit() {
    return this.field.unit ? html`<span>${this.speech.unit(this.field.unit)}</span>` : nothing;
  }

  #faultLines() {
    if (!this.faults.length) return nothing;
    const ranges = [...new Set(this.field.limits.map((limits) => this.#range(limits)).filter(Boolean))];
    return html`<p class="fault" id="${this.#id}-fault">
      ${this.faults.map((fault) => html`<span lang="en">${fault.detail}</span> `)}
      ${this.speech.language === "en" ? nothing : ranges.map((range) => html`<span>${range}</span> `)}
    </p>`;
  }

  render() {
    const { field } = this;
    const help = this.speech.language === "en" ? field.description : "";
    return html`<div class="field" data-kind=${field.kind} title=${help || nothing}>
      <label for=${this.#id}>${this.#label}</label>
      ${this.#control()} ${this.#faultLines()}
    </div>`;
  }
}

const RANK = ["uniaxial", "isotropic", "biaxial"];

customElements.define("isogyre-field", Field);
