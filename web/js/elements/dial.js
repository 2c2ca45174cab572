// A round scale turned with the pointer. The keyboard has the slider or number field beside it.

import { LitElement, html } from "../../vendor/lit.js";

export class Dial extends LitElement {
  static properties = {
    degrees: { attribute: false },
    face: { attribute: false }, // an svg template, drawn about (0, 0) in a circle of radius 50, y downwards
    disabled: { type: Boolean },
  };

  #held = null;

  createRenderRoot() {
    return this;
  }

  #pointed(event) {
    const box = this.getBoundingClientRect();
    const x = event.clientX - (box.left + box.width / 2);
    const y = event.clientY - (box.top + box.height / 2);
    return (-Math.atan2(y, x) * 180) / Math.PI;
  }

  #take(event) {
    if (this.disabled || event.button !== 0) return;
    event.preventDefault();
    event.currentTarget.setPointerCapture(event.pointerId);
    // What is turned follows the hand from where it was taken: nothing jumps.
    this.#held = { from: this.#pointed(event), at: this.degrees };
  }

  #turn(event) {
    if (!this.#held) return;
    const degrees = this.#held.at + this.#pointed(event) - this.#held.from;
    this.dispatchEvent(new CustomEvent("turn", { detail: degrees }));
  }

  #leave() {
    if (!this.#held) return;
    this.#held = null;
    this.dispatchEvent(new CustomEvent("settle"));
  }

  render() {
    return html`<svg
      viewBox="-60 -60 120 120"
      aria-hidden="true"
      @pointerdown=${this.#take}
      @pointermove=${this.#turn}
      @pointerup=${this.#leave}
      @pointercancel=${this.#leave}
    >
      ${this.face}
    </svg>`;
  }
}

customElements.define("isogyre-dial", Dial);
