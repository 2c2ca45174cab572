// Where the page begins.

import { Client } from "./client.js";
import { listen } from "./keyboard.js";
import { readLink, writeLink } from "./link.js";
import { firstLanguage, speeches } from "./speech.js";
import { Studio } from "./studio.js";
import "./elements/app.js";

const WRITE_MS = 250; // browsers refuse to be told a new address too often

const base = document.baseURI;
const studio = new Studio(new Client(base));
const app = document.querySelector("isogyre-app");
app.studio = studio;
app.speak(firstLanguage(), await speeches(base));
listen(studio);

const look = () => readLink(location.hash, (name) => studio.fieldsFor(name));
const still = matchMedia("(prefers-reduced-motion: reduce)");

/** Show what the address says: a link with an angle stands still there, any other turns, unless motion is unwelcome. */
async function show(open) {
  const { angle } = readLink(location.hash, () => []);
  studio.pause();
  if (angle === null && !still.matches) studio.play();
  try {
    await open();
  } catch (error) {
    studio.fail(error);
  }
}

still.addEventListener("change", () => still.matches && studio.pause());

let writing = 0;
let written = location.hash;
studio.addEventListener("change", () => {
  if (writing) return; // it will write what then is
  writing = setTimeout(() => {
    writing = 0;
    const { film, player, angle, fields } = studio;
    if (!film) return;
    const text = writeLink({ request: film.request, angle: player.playing ? null : angle, fields, first: film.first });
    if (`#${text}` === written) return;
    written = `#${text}`;
    history.replaceState(null, "", written);
  }, WRITE_MS);
});

addEventListener("hashchange", () => {
  if (location.hash === written) return;
  written = location.hash;
  show(() => studio.show(look()));
});

// Where only the controls are in sight, as on a telephone, the picture comes back when there is a new one to see.
studio.addEventListener("mount", () => {
  const stage = document.querySelector("isogyre-stage");
  if (stage && stage.getBoundingClientRect().bottom < 60)
    stage.scrollIntoView({ behavior: still.matches ? "auto" : "smooth" });
});

addEventListener("pagehide", (event) => {
  if (!event.persisted) studio.leave(); // a page that is kept may come back and go on
});

await show(() => studio.open(look));
