// The conversation with the simulation, and what a hand does.

const clock = document.getElementById("clock");
const trouble = document.getElementById("trouble");
const strength = document.getElementById("strength");
/** How near to a node the mouse takes hold of it (px). */
const REACH = axes === 3 ? 14 : 30;

const socket = new WebSocket(`${location.href.split(/[?#]/)[0].replace(/^http/, "ws")}socket`);
/** What is done with the answers that are still to come, one after the other. */
const awaited = [];

function send(message, then = () => {}) {
  if (socket.readyState !== WebSocket.OPEN) return;
  awaited.push(then);
  socket.send(JSON.stringify(message));
}

/** What is wrong, until something else is done. */
let complaint = "";

function tell(text) {
  complaint = text;
  showTrouble();
}

/** Gives an order; what was wrong before is past. */
function order(message) {
  tell("");
  send(message);
}

socket.addEventListener("message", (event) => {
  const answer = JSON.parse(event.data);
  const then = awaited.shift();
  if (answer.error) tell(answer.error);
  then?.(answer);
});
socket.addEventListener("open", () => {
  order({ do: "speed", value: SPEEDS[speedChoice.selectedIndex] });
  ask();
});
socket.addEventListener("close", () => {
  tell("The simulation has ended. Start pliant play anew, and open the address that it prints.");
  for (const control of document.querySelectorAll("button, input, select")) control.disabled = true;
});

function ask() {
  const since = times.length ? last : null;
  send({ do: "look", colours: quantities[chosen] ? chosen : null, since }, ({ frame: next }) => {
    if (next) show(next);
    requestAnimationFrame(ask);
  });
}

/** Decimals that tell a thousandth of the scene. */
const decimals = Math.min(6, Math.max(0, Math.round(3 - Math.log10(data.until || 1))));
const charts = [chartOfEnergies([energies]), ...chartsOfSensors([sensors])];
let scaleShown = -1;
let chartDrawn = 0;

function show(next) {
  take(next);
  // while a hand pulls, what is under it stays there
  if (!held) follow();
  const quantity = quantities[chosen];
  if (quantity && quantity.scale !== scaleShown) {
    scaleShown = quantity.scale;
    showScale(quantity);
  }
  draw();
  const now = performance.now();
  if (now - chartDrawn > 100 || !next.playing) {
    chartDrawn = now;
    for (const chart of charts) {
      chart.draw();
      chart.tell(last, [frame]);
    }
    showFacts();
  }
  clock.textContent = `${fixed(next.time, decimals)} s`;
  document.getElementById("phase").textContent = `phase: ${phaseAt().name}`;
  showSign(next.playing ? "Pause" : "Play");
  next.sliders.forEach((value, k) => {
    if (document.activeElement !== sliders[k].input || performance.now() - sliders[k].moved > 500) {
      sliders[k].show(value ?? 0);
    }
  });
  showTrouble();
}

function showTrouble() {
  const ended = frame.atEnd ? "This is the end of the scene: play begins anew." : "";
  trouble.textContent = complaint || frame.trouble || ended;
  trouble.hidden = !trouble.textContent;
}

function showFacts() {
  const { method, order, step, steps, evaluations, factorizations, factor, speed, playing } = frame;
  const count = (number) => number.toLocaleString("en");
  const size = step > 0 ? prefixed(step, "s") : null;
  const slow = playing && factor !== null && factor < speed ? ", slower than asked for" : "";
  listFacts(document.getElementById("facts"), {
    Mesh: `${count(data.mesh.nodes)} nodes, ${count(data.mesh.cells)} ${data.mesh.cellName}`,
    ...(frame.reduced ? { Model: frame.reduced } : {}),
    Method: method + (order ? `, order ${order}` : ""),
    Tolerance: signed(data.solver.rtol),
    "Step size": size ? `${number(step / size.factor)} ${size.unit}` : "none yet",
    Steps: count(steps),
    Evaluations: count(evaluations),
    Factorizations: count(factorizations),
    "Real-time factor": factor === null ? "none yet" : `${number(factor)}${slow}`,
  });
  const warnings = document.getElementById("warnings");
  warnings.hidden = frame.warnings.length === 0;
  warnings.replaceChildren(...frame.warnings.map((textContent) =>
    Object.assign(document.createElement("li"), { textContent })));
}

function draw() {
  drawStage({ time: frame.time });
  const { pull } = frame;
  if (!pull) return;
  const { place } = eyeOf();
  const [from, to] = [place(positionOf(pull.node)), place(pull.to)];
  const context = stage.getContext("2d");
  context.strokeStyle = context.fillStyle = paint("accent");
  context.lineWidth = 2;
  context.setLineDash([]);
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
  for (const [x, y] of [from, to]) {
    context.beginPath();
    context.arc(x, y, 4, 0, 7);
    context.fill();
  }
}

function redraw() {
  stage.style.height = `${wantedHeight()}px`;
  for (const chart of charts) chart.draw();
  draw();
}

function positionOf(node) {
  return Array.from(places.subarray(node * axes, (node + 1) * axes));
}

/** Where points (m) are in the picture (px), how deep, and what a way in the picture is in space. */
function eyeOf() {
  const sheet = { width: stage.clientWidth, height: stage.clientHeight };
  if (axes === 2) {
    const layout = layOut(sheet);
    return {
      place: ([x, y]) => [layout.x(x), layout.y(y)],
      depth: () => 0,
      way: (right, down) => [right / layout.scale, -down / layout.scale],
    };
  }
  const eye = look(sheet);
  return {
    place: eye.place,
    depth: eye.depth,
    way: (right, down) => eye.right.map((x, axis) => (right * x - down * eye.up[axis]) / eye.scale),
  };
}

/** The node that is held, and how far the mouse is from it (m). */
let held = null;

function spot(event) {
  const box = stage.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

function nodeAt([x, y]) {
  const { place, depth } = eyeOf();
  let nearest = null;
  // anchors of springs come after the nodes: they are not to be pulled
  for (let node = 0; node < body.nodes; node++) {
    const position = positionOf(node);
    const [px, py] = place(position);
    const distance = Math.hypot(px - x, py - y);
    // of two nodes that are as near, the one in front
    const rank = distance + (axes === 3 ? 1e-3 * depth(position) : 0);
    if (distance <= REACH && !(nearest?.rank <= rank)) nearest = { node, rank };
  }
  return nearest?.node ?? null;
}

function pullTo(event) {
  const [x, y] = spot(event);
  const { place, way } = eyeOf();
  // in space: in the plane of the picture through where the node was taken
  const [px, py] = place(held.from);
  const to = held.from.map((at, axis) => at + way(x - px, y - py)[axis]);
  send({ do: "pull", node: held.node, to, strength: 10 ** Number(strength.value) });
}

function letGo() {
  if (!held) return;
  held = null;
  send({ do: "let go" });
}

// before what turns bodies in space, which then has to leave it alone
stage.addEventListener("pointerdown", (event) => {
  const node = nodeAt(spot(event));
  if (node === null || event.button !== 0) return;
  event.preventDefault();
  event.stopImmediatePropagation();
  stage.setPointerCapture(event.pointerId);
  // a button that was pressed before does not take the space bar any more
  document.activeElement?.blur();
  held = { node, from: positionOf(node) };
  tell("");
  pullTo(event);
});
stage.addEventListener("pointermove", (event) => {
  if (!held) return;
  event.stopImmediatePropagation();
  pullTo(event);
});
for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, letGo);

/** A slider for every chamber without gas, every orifice, every spring and every component of a load. */
const sliders = data.sliders.map(({ name, what, unit, least, most }, place) => {
  const label = Object.assign(document.createElement("label"), { className: "slider" });
  const title = document.createElement("span");
  const output = document.createElement("output");
  const input = document.createElement("input");
  title.append(name, " ", Object.assign(document.createElement("small"), { textContent: what }));
  Object.assign(input, { type: "range", min: least, max: most, step: most / 100, value: 0 });
  label.append(title, input, output);
  document.getElementById("sliders").append(label);
  const scale = prefixed(most, unit);
  const slider = {
    input,
    moved: -Infinity,
    show(value) {
      input.value = value;
      tellValue(value);
    },
  };
  const tellValue = (value) => {
    output.textContent = `${number(value / scale.factor)} ${scale.unit}`;
    input.setAttribute("aria-valuetext", output.textContent);
  };
  input.addEventListener("input", () => {
    slider.moved = performance.now();
    tellValue(input.valueAsNumber);
    order({ do: "slide", slider: place, value: input.valueAsNumber });
  });
  return slider;
});

function toggle() {
  order({ do: frame.playing ? "pause" : "play" });
}

function goBack() {
  if (axes === 2) data.view = corners(data.motion.ranges);
  order({ do: "start" });
}

function setSpeed(steps) {
  changeSpeed(steps);
  order({ do: "speed", value: SPEEDS[speedChoice.selectedIndex] });
}

const KEYS = {
  " ": toggle,
  Home: goBack,
  "+": () => setSpeed(1),
  "-": () => setSpeed(-1),
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const at = event.target.tagName;
  // a slider goes to its end by Home, a button is pressed by the space bar
  if (at === "SELECT" || (event.key === "Home" && at === "INPUT")) return;
  if (event.key === " " && at === "BUTTON") return;
  const act = KEYS[event.key];
  if (!act) return;
  event.preventDefault();
  act();
});

function tellStrength() {
  document.getElementById("strength-value").textContent = `${number(10 ** Number(strength.value), 2)} \u00d7`;
}

const title = data.title || "A soft body in motion";
document.title = document.getElementById("title").textContent = title;
document.getElementById("end").textContent = `of ${fixed(data.until, decimals)} s`;
document.getElementById("save").hidden = !data.saves || !data.sliders.length;
document.getElementById("save").addEventListener("click", () => send({ do: "save" }, ({ file }) => {
  if (file === undefined) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([file], { type: "application/toml" }));
  link.download = data.saves;
  link.click();
  URL.revokeObjectURL(link.href);
}));
describeStage("The body in motion");
showKey();
offerQuantities(quantities, draw);
for (const chart of charts) chart.offerSeries(() => chart.draw());
offerSpeeds(data.until);
letTurn(draw);
showSign("Play");
tellStrength();
showTrouble();
playButton.addEventListener("click", toggle);
document.getElementById("start").addEventListener("click", goBack);
document.getElementById("slower").addEventListener("click", () => setSpeed(-1));
document.getElementById("faster").addEventListener("click", () => setSpeed(1));
speedChoice.addEventListener("change", () => setSpeed(0));
strength.addEventListener("input", tellStrength);
window.addEventListener("resize", redraw);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
redraw();
