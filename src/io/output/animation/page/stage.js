// The picture of the body and the key of its marks.

const stage = figure.querySelector("canvas");
const inSpace = axes === 3;

function drawStage(moment, drawing = sheet(stage)) {
  (inSpace ? drawSpace : drawPlane)(drawing, moment, quantities[chosen]);
}

/** Pixels per metre with which the motion fills the picture. */
function fitting() {
  const { clientWidth: width, clientHeight: height } = stage;
  return inSpace ? fitBall(width, height) : fitView(roomOn(width, height));
}

/** As high as the motion asks for, as far as the window has room (px). */
function wantedHeight() {
  const width = stage.clientWidth;
  const most = Math.max(240, Math.min(0.46 * window.innerHeight, 1.1 * width));
  let wanted = 0.6 * width;
  if (!inSpace) {
    const [low, high] = data.view;
    const shape = (high[1] - low[1]) / (high[0] - low[0]);
    wanted = (width - MARGIN.left - MARGIN.right) * shape + MARGIN.top + MARGIN.bottom;
  }
  return Math.round(Math.min(Math.max(wanted, 200), most));
}

function describeStage(what) {
  stage.setAttribute("aria-label", inSpace ? `${what}. Arrow keys turn it` : what);
  if (!inSpace) return;
  document.getElementById("turning").hidden = false;
  stage.tabIndex = 0;
  stage.classList.add("turns");
}

/** What the marks mean, as far as the motion has them. */
function showKey() {
  const dot = (colour, radius) => `<circle cx="11" cy="6" r="${radius}" fill="var(--${colour})"/>`;
  const zigzag = (colour) =>
    `<path d="M0 6h4l2-4 3 8 4-8 3 8 2-4h4" fill="none" stroke="var(--${colour})" stroke-width="1.6"/>`;
  const line = (colour) => `<path d="M0 6h22" fill="none" stroke="var(--${colour})" stroke-width="1.6"/>`;
  const arrow = (colour) =>
    `<path d="M1 6h13" fill="none" stroke="var(--${colour})" stroke-width="2"/>` +
    `<path d="M21 6l-8-4v8z" fill="var(--${colour})"/>`;
  const drives = springs.flatMap((spring) => [...spring.forces].map((force) => driven(spring, force)));
  const entries = [
    [phases.some((phase) => phase.held.length), dot("ink", 4), "held"],
    [phases.some((phase) => phase.moved.length), dot("moved", 4.5), "moved"],
    [data.points.length, dot("ink", 6), "point mass"],
    [springs.some((spring) => !spring.isCable), zigzag("spring"), "spring"],
    [springs.some((spring) => spring.isCable), line("spring"), "cable"],
    [drives.includes("pull"), line("pull"), "actuator pulls"],
    [drives.includes("push"), line("push"), "actuator pushes"],
    ...everywhere.map(({ name }) => [true, arrow(ACTING[name][0]), ACTING[name][1]]),
    [remanence.length, arrow("push"), "remanence"],
  ];
  const key = figure.querySelector(".key");
  for (const [, sign, meaning] of entries.filter(([exists]) => exists)) {
    const entry = document.createElement("li");
    entry.innerHTML = `<svg viewBox="0 0 22 12" aria-hidden="true">${sign}</svg>`;
    entry.append(meaning);
    key.append(entry);
  }
}

/** Turns a body in space by dragging, or by the arrow keys while the picture has the focus. */
function letTurn(redraw) {
  if (!inSpace) return;
  const turn = (right, up) => {
    view.azimuth -= right;
    view.elevation = Math.min(Math.max(view.elevation + up, -Math.PI / 2), Math.PI / 2);
    redraw();
  };
  stage.addEventListener("pointerdown", (event) => stage.setPointerCapture(event.pointerId));
  stage.addEventListener("pointermove", (event) => {
    if (stage.hasPointerCapture(event.pointerId)) turn(event.movementX / 150, event.movementY / 150);
  });
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  stage.addEventListener("keydown", (event) => {
    const step = steps[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    turn(...step.map((x) => 0.1 * x));
  });
}
