// Time: playing, seeking, speed, keys.

const slider = document.getElementById("time");
const clock = document.getElementById("clock");
const forceOfLongest = roundForce(Math.max(...pictures.map(({ strongest }) => strongest)));

let now = first;
/** Time stamp of the last frame (ms) while the motion is played; null otherwise. */
let played = null;

/** Decimals that tell a thousandth of the motion. */
const decimals = Math.min(6, Math.max(0, Math.round(3 - Math.log10(last - first || 1))));

function show() {
  for (const picture of pictures) drawFrame(picture, sheet(picture.stage));
  const moments = pictures.map(({ momentAt }) => momentAt(now));
  for (const chart of charts) chart.tell(now, moments);
  const time = `${fixed(now, decimals)} s`;
  const told = pictures.map((picture, k) => {
    const { name } = picture.phaseAt(now);
    const ended = now > picture.last ? `, ended at ${fixed(picture.last, decimals)} s` : "";
    figures[k].querySelector(".phase").textContent = `phase: ${name}${ended}`;
    return `${several ? `${picture.name}: ` : ""}phase ${name}${ended}`;
  });
  slider.value = now;
  slider.setAttribute("aria-valuetext", [time, ...told].join(", "));
  clock.textContent = time;
}

function drawFrame({ momentAt, drawStage, drawContacts }, drawing) {
  drawStage(momentAt(now), drawing);
  if (arrows.checked) drawContacts(drawing, momentAt(now), forceOfLongest);
}

function redraw() {
  const height = Math.max(...pictures.map(({ wantedHeight }) => wantedHeight()));
  for (const { stage } of pictures) stage.style.height = `${height}px`;
  for (const chart of charts) chart.draw();
  show();
}

function seek(time) {
  now = Math.min(Math.max(time, first), last);
  show();
}

function pause() {
  played = null;
  showSign("Play");
}

function play() {
  if (played !== null || last === first) return;
  if (now >= last) now = first;
  played = performance.now();
  showSign("Pause");
  requestAnimationFrame(advance);
}

function advance(stamp) {
  if (played === null) return;
  const passed = Math.max(0, stamp - played) / 1000;
  played = stamp;
  seek(now + passed * SPEEDS[speedChoice.selectedIndex]);
  if (now >= last) pause();
  else requestAnimationFrame(advance);
}

function toggle() {
  if (played === null) play();
  else pause();
}

/** Goes `count` samples on, or back, and stays there. */
function step(count) {
  pause();
  const { before, share } = momentIn(times, now);
  // between two samples, the one before is one step back
  const from = count < 0 && share > 0 && share < 1 ? before + 1 : before + (share === 1 ? 1 : 0);
  seek(times[Math.min(Math.max(from + count, 0), times.length - 1)]);
}

const KEYS = {
  " ": toggle,
  ArrowLeft: (event) => step(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
  Home: () => seek(first),
  End: () => seek(last),
  "+": () => changeSpeed(1),
  "-": () => changeSpeed(-1),
  p: savePixels,
  s: saveVectors,
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const at = event.target.tagName;
  if (at === "SELECT" || (event.key === " " && (["BUTTON", "SUMMARY"].includes(at) || event.target === arrows))) return;
  const act = KEYS[event.key];
  if (!act) return;
  event.preventDefault();
  act(event);
});

function factsOf({ run, times }) {
  const count = (number) => number.toLocaleString("en");
  const energy = (value) => {
    const { factor, unit } = prefixed(value, "J");
    return `${number(value / factor, 2)} ${unit}`;
  };
  const shown = times.length === run.samples
    ? `all ${count(run.samples)}`
    : `${count(times.length)} of ${count(run.samples)}, evenly thinned for this page`;
  return {
    Mesh: `${count(run.nodes)} nodes, ${count(run.cells)} ${run.cellName}`,
    Method: `${run.method}, relative tolerance ${signed(run.rtol)}`,
    Effort: `${count(run.steps)} steps, ${count(run.factorizations)} factorizations, ${number(run.seconds)} s`,
    "Energy balance": `off by at most ${energy(run.energyError)}, of ${energy(run.energyScale)}`,
    Samples: `${shown}; straight lines between them`,
  };
}

/** What stays as it is while the motions are played. */
function tellFacts() {
  const title = page.title || names.filter(Boolean).join(" | ") || "Motion of a soft body";
  document.title = document.getElementById("title").textContent = title;
  document.getElementById("end").textContent = `of ${fixed(last, decimals)} s`;
  const warnings = document.getElementById("warnings");
  pictures.forEach(({ name, data, describeStage, showKey }, k) => {
    const about = several ? `${name}: ` : "";
    const [from, to] = [data.times[0], data.times[data.times.length - 1]];
    describeStage(`${about}Motion of the body from ${number(from)} to ${number(to)} seconds`);
    showKey();
    for (const heading of [figures[k], computations[k]].map((part) => part.querySelector(".name"))) {
      heading.hidden = !several;
      heading.innerHTML = strokeSign("currentColor", STROKES[k % STROKES.length]);
      heading.append(name);
    }
    listFacts(computations[k].querySelector("dl"), factsOf(data));
    computations[k].querySelector("pre").textContent = data.report;
    for (const warning of data.warnings) {
      warnings.append(Object.assign(document.createElement("li"), { textContent: about + warning }));
    }
  });
  warnings.hidden = warnings.children.length === 0;
}

document.body.classList.toggle("several", several);
tellFacts();
offerQuantities(quantities, show);
offerArrows(pictures.some(({ data }) => data.contacts.length), forceOfLongest, show);
offerSpeeds(last - first);
for (const chart of charts) {
  chart.offerSeries(redraw);
  chart.letSeek(seek);
}
for (const { letTurn } of pictures) letTurn(show);
showSign("Play");
Object.assign(slider, { min: first, max: last, step: "any" });
slider.addEventListener("input", () => seek(Number(slider.value)));
playButton.addEventListener("click", toggle);
document.getElementById("png").addEventListener("click", savePixels);
document.getElementById("svg").addEventListener("click", saveVectors);
window.addEventListener("resize", redraw);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
redraw();
