// The few signs on the buttons.

import { html } from "../../vendor/lit.js";

const icon = (d) => html`<svg class="icon" viewBox="0 0 24 24" aria-hidden="true"><path d=${d}></path></svg>`;

export const PLAY = icon("M8 5v14l11-7z");
export const PAUSE = icon("M7 5h4v14H7zM13 5h4v14h-4z");
export const BACK = icon("M15.5 5v14l-9-7z");
export const ON = icon("M8.5 5v14l9-7z");
