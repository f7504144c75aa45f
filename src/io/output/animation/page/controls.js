// The button that plays, the choice of speeds, the list of facts.

const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50];
/** A motion is played, at first, in about this time (s). */
const COMFORTABLE = 8;
const SIGNS = { Play: "M8 5v14l11-7z", Pause: "M7 5h4v14H7zM13 5h4v14h-4z" };

const playButton = document.getElementById("play");
const speedChoice = document.getElementById("speed");

function showSign(action) {
  playButton.setAttribute("aria-label", action);
  document.getElementById("sign").setAttribute("d", SIGNS[action]);
}

/** The choice of speeds, at first one that suits a motion of `span` seconds. */
function offerSpeeds(span) {
  for (const speed of SPEEDS) {
    const label = speed < 1 ? `1/${Math.round(1 / speed)}` : String(speed);
    speedChoice.append(new Option(speed === 1 ? "real time" : `${label} \u00d7`));
  }
  const distance = (speed) => Math.abs(Math.log(span / speed / COMFORTABLE));
  const nearest = SPEEDS.reduce((a, b) => (distance(b) < distance(a) ? b : a));
  speedChoice.selectedIndex = span > 0 ? SPEEDS.indexOf(nearest) : SPEEDS.indexOf(1);
}

function changeSpeed(steps) {
  const index = speedChoice.selectedIndex + steps;
  speedChoice.selectedIndex = Math.min(Math.max(index, 0), SPEEDS.length - 1);
}

/** Lists `facts`, text by name. */
function listFacts(list, facts) {
  list.replaceChildren(...Object.entries(facts).flatMap(([name, content]) => [
    Object.assign(document.createElement("dt"), { textContent: name }),
    Object.assign(document.createElement("dd"), { textContent: content }),
  ]));
}
