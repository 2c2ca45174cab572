// What is drawn on the dials.

import { nothing, svg } from "../../vendor/lit.js";
import { outline } from "../outline.js";

const spoke = (degrees, inner, outer, name) => {
  const a = (degrees * Math.PI) / 180;
  return svg`<line class=${name} x1=${inner * Math.cos(a)} y1=${-inner * Math.sin(a)} x2=${outer * Math.cos(a)} y2=${-outer * Math.sin(a)}></line>`;
};

const scale = (step, long) =>
  Array.from({ length: 360 / step }, (_, i) => spoke(i * step, (i * step) % long === 0 ? 44 : 47, 50, "tick"));

const SQUARE = [
  [-1, -1],
  [1, -1],
  [1, 1],
  [-1, 1],
];

/** The outline of the specimen, as large as the dial's inner circle allows. */
function specimen(vertices) {
  const corners = vertices ? outline(vertices) : SQUARE;
  const scale = 30 / Math.max(...corners.map(([x, y]) => Math.hypot(x, y)));
  const points = corners.map(([x, y]) => `${(x * scale).toFixed(2)},${(-y * scale).toFixed(2)}`).join(" ");
  return svg`<polygon class="block" points=${points}></polygon>`;
}

/** The stage from above: the specimen, its optic axis, the analyser's transmission axis. */
export function stageFace({ degrees, azimuth, analyser, vertices }) {
  return svg`
    <circle class="rim" r="50"></circle>
    ${scale(10, 30)}
    ${analyser === null ? nothing : svg`${spoke(analyser, 0, 42, "analyser")}${spoke(analyser + 180, 0, 42, "analyser")}`}
    <g transform="rotate(${-degrees})">
      ${specimen(vertices)}
      <path class="index" d="M50 0 l7 -4 v8 z"></path>
      ${azimuth === null ? nothing : svg`<g transform="rotate(${-azimuth})"><path class="axis" d="M-32 0 H32 M25 -4.5 L32 0 L25 4.5"></path></g>`}
    </g>`;
}

/** The analyser: lines along its transmission axis. */
export function analyserFace(degrees) {
  const lines = [-32, -24, -16, -8, 0, 8, 16, 24, 32].map((y) => {
    const x = Math.sqrt(40 ** 2 - y ** 2);
    return svg`<line class="grating" x1=${-x} x2=${x} y1=${y} y2=${y}></line>`;
  });
  return svg`
    <circle class="rim" r="50"></circle>
    ${scale(10, 30)}
    <g transform="rotate(${-degrees})">
      <circle class="pane" r="40"></circle>
      ${lines}
      <path class="index" d="M50 0 l7 -4 v8 z"></path>
      <path class="index" d="M-50 0 l-7 -4 v8 z"></path>
    </g>`;
}
