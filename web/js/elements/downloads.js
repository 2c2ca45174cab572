// The files to take home.

import { html, nothing } from "../../vendor/lit.js";
import { Piece } from "./piece.js";

export class Downloads extends Piece {
  render() {
    const { studio } = this;
    const { film } = studio;
    const view = studio.view;
    const whole = film?.job.status === "successful";
    const links = film?.job.links ?? {};
    const file = (href, name, key) =>
      href
        ? html`<a href=${studio.client.address(href)} download=${name}>${this.say(key)}</a>`
        : html`<span aria-disabled="true">${this.say(key)}</span>`;
    const name = film ? film.request.demonstration : "isogyre";
    return html`<nav class="downloads" aria-label=${this.say("download.title")}>
      <span>${this.say("download.title")}</span>
      ${file(view?.state === "exact" ? view.picture.png : null, view ? `${name}-${view.picture.angle}.png` : "", "download.png")}
      ${film && film.count > 1 ? file(whole ? links.sequence : null, `${name}.webp`, "download.sequence") : nothing}
      ${file(whole ? links.manifest : null, `${name}-manifest.json`, "download.manifest")}
    </nav>`;
  }
}

customElements.define("isogyre-downloads", Downloads);
