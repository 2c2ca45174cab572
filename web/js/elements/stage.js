// The picture, large, and what is to be said about it while it is not the right one.

import { html, nothing } from "../../vendor/lit.js";
import { decimals } from "../angle.js";
import { Piece } from "./piece.js";

export class Stage extends Piece {
  #drawn = null;
  #held = null;

  #words() {
    const { studio } = this;
    const view = studio.view;
    if (view?.state === "exact") return nothing;
    const angle = this.angle(studio.angle, decimals(studio.angle));
    if (studio.running || studio.stills.waiting)
      return view?.state === "stale" || !view ? this.say("stage.coming") : this.say("stage.computing", { angle });
    return view ? this.say("stage.absent", { angle }) : this.say("stage.empty");
  }

  #described(view) {
    if (!view || view.state === "stale") return this.say("stage.none");
    const { parameters, demonstration } = this.studio.film.request;
    const title = this.speech.pick(
      this.studio.demonstrations.find((d) => d.name === demonstration)?.title,
      demonstration,
    );
    const mineral = this.studio.minerals.find((m) => m.id === parameters.mineral);
    return this.say("stage.described", {
      title,
      mineral: this.speech.pick(mineral?.names, parameters.mineral ?? ""),
      angle: this.angle(view.picture.angle, decimals(view.picture.angle)),
    });
  }

  // A turn about the middle of the picture turns the stage, frame by frame. A finger scrolls the page instead.
  #direction(event) {
    const box = event.currentTarget.getBoundingClientRect();
    return (
      (-Math.atan2(event.clientY - box.top - box.height / 2, event.clientX - box.left - box.width / 2) * 180) / Math.PI
    );
  }

  #take(event) {
    if (event.button !== 0 || event.pointerType === "touch" || !this.studio.film) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    this.studio.pause();
    this.#held = { from: this.#direction(event), at: this.studio.angle };
  }

  #turn(event) {
    if (!this.#held) return;
    const wanted = this.#held.at + this.#direction(event) - this.#held.from;
    this.studio.turnNear(wanted);
  }

  #leave() {
    this.#held = null;
  }

  render() {
    const view = this.studio.view;
    const words = this.#words();
    return html`<div class="frame" data-state=${view?.state ?? "none"}>
      <canvas
        role="img"
        aria-label=${this.#described(view)}
        data-angle=${view ? view.picture.angle : ""}
        data-quality=${view ? view.picture.quality : ""}
        @pointerdown=${this.#take}
        @pointermove=${this.#turn}
        @pointerup=${this.#leave}
        @pointercancel=${this.#leave}
      ></canvas>
      <p class="veil" ?hidden=${words === nothing}>${words}</p>
    </div>`;
  }

  updated() {
    const image = this.studio.view?.picture.image;
    if (!image || image === this.#drawn) return;
    const canvas = this.querySelector("canvas");
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    canvas.getContext("2d").drawImage(image, 0, 0);
    this.style.setProperty("--ratio", image.naturalWidth / image.naturalHeight);
    this.#drawn = image;
  }
}

customElements.define("isogyre-stage", Stage);
