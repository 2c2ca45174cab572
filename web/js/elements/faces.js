// What is drawn on the dials.

import { nothing, svg } from "../../vendor/lit.js";

const spoke = (degrees, inner, outer, name) => {
  const a = (degrees * Math.PI) / 180;
  return svg`<line class=${name} x1=${inner * Math.cos(a)} y1=${-inner * Math.sin(a)} x2=${outer * Math.cos(a)} y2=${-outer * Math.sin(a)}></line>`;
};

const scale = (step, long) =>
  Array.from({ length: 360 / step }, (_, i) => spoke(i * step, (i * step) % long === 0 ? 44 : 47, 50, "tick"));

/** The stage from above: the block, its optic axis, the analyser's transmission axis. */
export function stageFace({ degrees, azimuth, analyser }) {
  return svg`
    <circle class="rim" r="50"></circle>
    ${scale(10, 30)}
    ${analyser === null ? nothing : svg`${spoke(analyser, 0, 42, "analyser")}${spoke(analyser + 180, 0, 42, "analyser")}`}
    <g transform="rotate(${-degrees})">
      <rect class="block" x="-20" y="-20" width="40" height="40" rx="1"></rect>
      <path class="index" d="M50 0 l7 -4 v8 z"></path>
      ${azimuth === null ? nothing : svg`<g transform="rotate(${-azimuth})"><path class="axis" d="M-26 0 H26 M20 -4.5 L27 0 L20 4.5"></path></g>`}
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
