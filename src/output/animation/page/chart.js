// The energies over time, with a line at the time that is shown.

const chart = document.getElementById("chart");
const plot = document.getElementById("plot");
const cursor = document.getElementById("cursor");
const PLOT = { left: 58, right: 14, top: 26, bottom: 36, height: 230 };
/** Lines that differ by more than their colour. */
const DASHES = { gravity: [8, 3], springs: [2, 2], dissipated: [10, 3, 2, 3], supplied: [5, 4], balance: [1, 3] };

const hidden = new Set();
/** The buttons of the series, and where they show the value of the moment. */
const switches = [];
/** Unit of the energies, and the decimals that tell a thousandth of the largest. */
let energyUnit = { factor: 1, unit: "J", decimals: 3 };

function timeAt(x) {
  const share = (x - PLOT.left) / (plot.clientWidth - PLOT.left - PLOT.right);
  return first + Math.min(Math.max(share, 0), 1) * (last - first);
}

function xOf(time) {
  const room = plot.clientWidth - PLOT.left - PLOT.right;
  return PLOT.left + (last > first ? (time - first) / (last - first) : 0) * room;
}

function drawChart() {
  plot.style.height = `${PLOT.height}px`;
  const { context, width, height } = sheet(plot);
  const shown = energies.filter((series) => !hidden.has(series.name));
  const [low, high] = rangeOf(shown);
  const right = width - PLOT.right;
  const floor = height - PLOT.bottom;
  const yOf = (value) => floor - ((value - low) / (high - low)) * (floor - PLOT.top);
  context.fillStyle = paint("muted");
  context.strokeStyle = paint("grid");
  context.beginPath();
  const upward = ticks(low / energyUnit.factor, high / energyUnit.factor, 5);
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const value of upward.values) {
    const y = yOf(value * energyUnit.factor);
    context.moveTo(PLOT.left, y);
    context.lineTo(right, y);
    context.fillText(fixed(value, upward.decimals), PLOT.left - 8, y);
  }
  context.fillText(energyUnit.unit, PLOT.left - 8, 9);
  context.textAlign = "center";
  context.textBaseline = "top";
  if (last > first) {
    const along = ticks(first, last, Math.min(8, (right - PLOT.left) / 80));
    for (const value of along.values) {
      const x = xOf(value);
      context.moveTo(x, PLOT.top);
      context.lineTo(x, floor);
      context.fillText(fixed(value, along.decimals), x, floor + 7);
    }
  }
  context.stroke();
  context.fillText("time (s)", (PLOT.left + right) / 2, floor + 22);
  drawPhases(context, floor);
  context.save();
  context.beginPath();
  context.rect(PLOT.left - 1, PLOT.top - 2, right - PLOT.left + 2, floor - PLOT.top + 4);
  context.clip();
  context.lineWidth = 2;
  for (const { name, values } of shown) {
    context.strokeStyle = paint(name);
    context.setLineDash(DASHES[name] ?? []);
    context.beginPath();
    values.forEach((value, k) => context.lineTo(xOf(times[k]), yOf(value)));
    context.stroke();
  }
  context.restore();
  cursor.style.top = `${PLOT.top}px`;
  cursor.style.height = `${floor - PLOT.top}px`;
}

/** The ends of the phases, and their names where there is room. */
function drawPhases(context, floor) {
  context.save();
  context.strokeStyle = paint("hatch");
  context.setLineDash([3, 3]);
  context.textAlign = "left";
  context.textBaseline = "middle";
  let from = first;
  for (const { name, end } of phases.filter((phase, k) => k === 0 || phases[k - 1].end < last)) {
    const [left, right] = [xOf(from), xOf(Math.min(end, last))];
    if (end < last) {
      context.beginPath();
      context.moveTo(right, 6);
      context.lineTo(right, floor);
      context.stroke();
    }
    if (context.measureText(name).width + 8 < right - left) context.fillText(name, left + 5, 11);
    from = end;
  }
  context.restore();
}

/** From the least to the largest energy shown, 0 included, and the unit for them. */
function rangeOf(shown) {
  let [low, high] = [0, 0];
  for (const { values } of shown) {
    for (const value of values) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (low === high) high = 1;
  const largest = Math.max(-low, high);
  energyUnit = prefixed(largest, "J");
  energyUnit.decimals = Math.max(0, 3 - Math.floor(Math.log10(largest / energyUnit.factor)));
  const pad = 0.04 * (high - low);
  return [low < 0 ? low - pad : 0, high + pad];
}

/** Moves the line to the moment and tells the energies there. */
function showEnergies(moment) {
  cursor.style.transform = `translateX(${xOf(moment.time)}px)`;
  const { factor, unit, decimals } = energyUnit;
  for (const { series, value } of switches) {
    value.textContent = `${fixed(energyAt(moment, series) / factor, decimals)} ${unit}`;
  }
}

/** A button for each series that shows and hides it; `redraw` is called after that. */
function offerSeries(redraw) {
  const list = document.getElementById("series");
  for (const series of energies) {
    const button = document.createElement("button");
    const value = document.createElement("span");
    value.className = "value";
    button.type = "button";
    button.setAttribute("aria-pressed", "true");
    const dash = (DASHES[series.name] ?? []).join(" ");
    button.innerHTML =
      `<svg viewBox="0 0 22 10" aria-hidden="true"><path d="M0 5h22" stroke="var(--${series.name})" ` +
      `stroke-width="2.5" stroke-dasharray="${dash}"/></svg>`;
    button.append(series.name, value);
    button.addEventListener("click", () => {
      const shown = hidden.delete(series.name);
      if (!shown) hidden.add(series.name);
      button.setAttribute("aria-pressed", String(shown));
      redraw();
    });
    list.append(button);
    switches.push({ series, value });
  }
}

/** Clicking and dragging on the chart goes to the time there. */
function letSeek(seek) {
  const go = (event) => seek(timeAt(event.clientX - plot.getBoundingClientRect().left));
  chart.addEventListener("pointerdown", (event) => {
    chart.setPointerCapture(event.pointerId);
    go(event);
  });
  chart.addEventListener("pointermove", (event) => {
    if (chart.hasPointerCapture(event.pointerId)) go(event);
  });
}
