// Lines over time, with a line at the time that is shown.

const PLOT = { left: 58, right: 14, top: 26, bottom: 36, height: 230 };
/** Lines of energies that differ by more than their colour. */
const DASHES = { gravity: [8, 3], springs: [2, 2], dissipated: [10, 3, 2, 3], supplied: [5, 4], balance: [1, 3] };

/** For lines beyond the colours, and for motions that share a chart. */
const STROKES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

/** The series of one chart from the lines of each motion: what has the same name is one of them, with a line for each motion that has it. */
function seriesOf(motions, colourOf, dashesOf) {
  const names = [...new Set(motions.flat().map(({ name }) => name))];
  return names.map((name, k) => ({
    name,
    colour: colourOf(name, k),
    lines: motions.map((lines, motion) => {
      const line = lines.find((line) => line.name === name);
      return line && { ...line, dashes: motions.length > 1 ? STROKES[motion % STROKES.length] : dashesOf(name, k) };
    }),
  }));
}

/** `series` of one unit; a button for each shows and hides its lines. */
class Chart {
  hidden = new Set();
  /** The lines of the series, and where their buttons show the values of the moment. */
  switches = [];

  /** In the elements `frame`, `plot`, `cursor` and `list`; `withZero`: 0 is in the range. */
  constructor(elements, series, unit, withZero) {
    Object.assign(this, elements, { series, unit, withZero });
    /** Unit of the numbers, and the decimals that tell a thousandth of the largest. */
    this.scale = { factor: 1, unit, decimals: 3 };
  }

  timeAt(x) {
    const share = (x - PLOT.left) / (this.plot.clientWidth - PLOT.left - PLOT.right);
    return first + Math.min(Math.max(share, 0), 1) * (last - first);
  }

  xOf(time) {
    const room = this.plot.clientWidth - PLOT.left - PLOT.right;
    return PLOT.left + (last > first ? (time - first) / (last - first) : 0) * room;
  }

  draw() {
    this.plot.style.height = `${PLOT.height}px`;
    const { context, width, height } = sheet(this.plot);
    const shown = this.series.filter((series) => !this.hidden.has(series.name));
    const [low, high] = this.range(shown);
    const right = width - PLOT.right;
    const floor = height - PLOT.bottom;
    const yOf = (value) => floor - ((value - low) / (high - low)) * (floor - PLOT.top);
    context.fillStyle = paint("muted");
    context.strokeStyle = paint("grid");
    context.beginPath();
    const { factor, unit } = this.scale;
    const upward = ticks(low / factor, high / factor, 5);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const value of upward.values) {
      const y = yOf(value * factor);
      context.moveTo(PLOT.left, y);
      context.lineTo(right, y);
      context.fillText(fixed(value, upward.decimals), PLOT.left - 8, y);
    }
    context.fillText(unit, PLOT.left - 8, 9);
    context.textAlign = "center";
    context.textBaseline = "top";
    if (last > first) {
      const along = ticks(first, last, Math.min(8, (right - PLOT.left) / 80));
      for (const value of along.values) {
        const x = this.xOf(value);
        context.moveTo(x, PLOT.top);
        context.lineTo(x, floor);
        context.fillText(fixed(value, along.decimals), x, floor + 7);
      }
    }
    context.stroke();
    context.fillText("time (s)", (PLOT.left + right) / 2, floor + 22);
    this.drawPhases(context, floor);
    context.save();
    context.beginPath();
    context.rect(PLOT.left - 1, PLOT.top - 2, right - PLOT.left + 2, floor - PLOT.top + 4);
    context.clip();
    context.lineWidth = 2;
    const lines = shown.flatMap(({ colour, lines }) => lines.map((line) => line && { ...line, colour }));
    for (const { times, values, colour, dashes } of lines.filter(Boolean)) {
      context.strokeStyle = paint(colour);
      context.setLineDash(dashes);
      context.beginPath();
      // a value that is no number leaves a gap
      values.forEach((value, k) => {
        if (!Number.isFinite(value)) return;
        const go = Number.isFinite(values[k - 1]) ? "lineTo" : "moveTo";
        context[go](this.xOf(times[k]), yOf(value));
      });
      context.stroke();
    }
    context.restore();
    this.cursor.style.top = `${PLOT.top}px`;
    this.cursor.style.height = `${floor - PLOT.top}px`;
  }

  /** The ends of the phases, and their names where there is room. */
  drawPhases(context, floor) {
    context.save();
    context.strokeStyle = paint("hatch");
    context.setLineDash([3, 3]);
    context.textAlign = "left";
    context.textBaseline = "middle";
    let from = first;
    for (const { name, end } of phases.filter((phase, k) => k === 0 || phases[k - 1].end < last)) {
      const [left, right] = [this.xOf(from), this.xOf(Math.min(end, last))];
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

  /** From the least to the largest number shown, with some room, and the unit for them. */
  range(shown) {
    let [low, high] = this.withZero ? [0, 0] : [Infinity, -Infinity];
    for (const { values } of shown.flatMap(({ lines }) => lines.filter(Boolean))) {
      for (const value of values) {
        if (!Number.isFinite(value)) continue;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    if (low > high) [low, high] = [0, 0];
    const largest = Math.max(-low, high) || 1;
    // all alike, but for round-off
    if (high - low <= 1e-6 * largest && !this.withZero) [low, high] = [low - 0.1 * largest, high + 0.1 * largest];
    if (low === high) high = 1;
    this.scale = scaled(largest, this.unit);
    this.scale.decimals = Math.max(0, 3 - Math.floor(Math.log10(largest / this.scale.factor)));
    const pad = 0.04 * (high - low);
    return [low < 0 || !this.withZero ? low - pad : 0, high + pad];
  }

  /** Moves the line to `time` and tells the values at the moments of the motions. */
  tell(time, moments) {
    this.cursor.style.transform = `translateX(${this.xOf(time)}px)`;
    const { factor, unit, decimals } = this.scale;
    const told = (now) => (Number.isFinite(now) ? `${fixed(now / factor, decimals)} ${unit}`.trimEnd() : "no value");
    for (const { lines, values } of this.switches) {
      lines.forEach((line, motion) => {
        values[motion].textContent = line ? told(seriesAt(moments[motion], line)) : "none";
      });
    }
  }

  /** A button for each series that shows and hides it; `redraw` is called after that. */
  offerSeries(redraw) {
    for (const { name, colour, lines } of this.series) {
      const button = document.createElement("button");
      button.type = "button";
      button.setAttribute("aria-pressed", "true");
      const dashes = lines.length > 1 ? [] : lines[0].dashes;
      button.innerHTML = strokeSign(`var(--${colour})`, dashes);
      const values = lines.map(() => Object.assign(document.createElement("span"), { className: "value" }));
      button.append(name, ...values);
      button.addEventListener("click", () => {
        const shown = this.hidden.delete(name);
        if (!shown) this.hidden.add(name);
        button.setAttribute("aria-pressed", String(shown));
        redraw();
      });
      this.list.append(button);
      this.switches.push({ lines, values });
    }
  }

  /** Clicking and dragging on the chart goes to the time there. */
  letSeek(seek) {
    const go = (event) => seek(this.timeAt(event.clientX - this.plot.getBoundingClientRect().left));
    this.frame.addEventListener("pointerdown", (event) => {
      this.frame.setPointerCapture(event.pointerId);
      go(event);
    });
    this.frame.addEventListener("pointermove", (event) => {
      if (this.frame.hasPointerCapture(event.pointerId)) go(event);
    });
  }
}

/** A piece of a line, as the drawing of a key. */
function strokeSign(colour, dashes) {
  return (
    `<svg viewBox="0 0 22 10" aria-hidden="true"><path d="M0 5h22" stroke="${colour}" ` +
    `stroke-width="2.5" stroke-dasharray="${dashes.join(" ")}"/></svg>`
  );
}

/** The chart of the energies of each motion. */
function chartOfEnergies(motions) {
  return new Chart(
    {
      frame: document.getElementById("chart"),
      plot: document.getElementById("plot"),
      cursor: document.getElementById("cursor"),
      list: document.getElementById("series"),
    },
    seriesOf(motions, (name) => name, (name) => DASHES[name] ?? []),
    "J",
    true,
  );
}
