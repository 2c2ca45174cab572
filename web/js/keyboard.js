// Keys that work wherever no control of its own wants them: space, arrows, Home, End.

const OWNERS = "input, select, textarea, button, summary, a, [contenteditable]";

export function listen(studio) {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.target instanceof Element && event.target.closest(OWNERS) && !turnsTheStage(event)) return;
    if (!act(studio, event.key)) return;
    event.preventDefault();
  });
}

/** Space on the stage's slider plays: a range input has no use for it. */
function turnsTheStage(event) {
  return event.key === " " && event.target.id === "turn";
}

function act(studio, key) {
  if (!studio.film) return false;
  switch (key) {
    case " ":
      if (studio.player.playing) studio.pause();
      else studio.play();
      return true;
    case "ArrowLeft":
      studio.step(-1);
      return true;
    case "ArrowRight":
      studio.step(1);
      return true;
    case "Home":
    case "End":
      studio.toEnd(key === "End");
      return true;
    default:
      return false;
  }
}
