// What went wrong, in words: the whole of the problem, and those of its errors that no control of the page can show.

import { html, nothing } from "../../vendor/lit.js";
import { Problem } from "../problem.js";
import { Piece } from "./piece.js";

export class Trouble extends Piece {
  #homeless(problem) {
    const shown = ["/quality", "/size", "/frames", "/seed", ...this.studio.fields.map((f) => `/parameters/${f.name}`)];
    const placed = new Set(shown.flatMap((pointer) => problem.at(pointer)));
    return problem.errors.filter((error) => !placed.has(error));
  }

  #words(problem) {
    if (!(problem instanceof Problem))
      return html`<p>${this.say("trouble.page")}</p>
        <p lang="en">${problem.message}</p>`;
    if (problem.unreachable) return html`<p>${this.say("trouble.unreachable")}</p>`;
    const homeless = this.#homeless(problem);
    const about = problem.errors.length > homeless.length ? this.say("trouble.marked") : nothing;
    // Where every error stands at its control, the service's summary would only say it again.
    const summary =
      homeless.length === 0 && problem.errors.length > 0
        ? ""
        : [problem.title, problem.detail].filter(Boolean).join(": ");
    return html`<p><strong>${this.say("trouble.refused")}</strong> ${about}</p>
      ${summary ? html`<p lang="en">${summary}</p>` : nothing}
      ${
        homeless.length
          ? html`<ul>
              ${homeless.map((e) => html`<li lang="en">${e.pointer ? html`<code>${e.pointer}</code> ` : nothing}${e.detail}</li>`)}
            </ul>`
          : nothing
      }`;
  }

  render() {
    const { problem } = this.studio;
    return html`<div class="trouble" role="alert" ?hidden=${!problem}>
      ${problem ? this.#words(problem) : nothing}
    </div>`;
  }
}

customElements.define("isogyre-trouble", Trouble);
