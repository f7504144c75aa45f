// Colours, and canvases that are sharp on every screen.

const VIRIDIS = [
  [68, 1, 84], [72, 40, 120], [62, 73, 137], [49, 104, 142], [38, 130, 142],
  [31, 158, 137], [53, 183, 121], [110, 206, 88], [181, 222, 43], [253, 231, 37],
];
const FONT = "12px system-ui, 'Segoe UI', Helvetica, Arial, sans-serif";

/** Colours of the values 0 to 255. */
const colours = Array.from({ length: 256 }, (_, value) => {
  const at = (value / 255) * (VIRIDIS.length - 1);
  const k = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[k].map((from, i) => Math.round(from + (VIRIDIS[k + 1][i] - from) * (at - k)));
});

/** A colour of the style sheet, which knows whether the page is light or dark. */
function paint(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

function rgb([red, green, blue], light = 1) {
  return `rgb(${[red, green, blue].map((part) => Math.round(part * light))})`;
}

/** A canvas made as fine as the screen, cleared, and its size in CSS pixels. */
function sheet(canvas) {
  const fine = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  const wanted = [Math.round(width * fine), Math.round(height * fine)];
  if (canvas.width !== wanted[0] || canvas.height !== wanted[1]) {
    [canvas.width, canvas.height] = wanted;
  }
  const context = canvas.getContext("2d");
  context.setTransform(fine, 0, 0, fine, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = FONT;
  context.lineJoin = "round";
  return { context, width, height, hatching: () => hatching(context) };
}

/** Slanted lines, to fill what is solid. */
function hatching(context) {
  const tile = document.createElement("canvas");
  const fine = window.devicePixelRatio || 1;
  const size = 8;
  tile.width = tile.height = size * fine;
  const lines = tile.getContext("2d");
  lines.scale(fine, fine);
  lines.fillStyle = paint("solid");
  lines.fillRect(0, 0, size, size);
  lines.strokeStyle = paint("hatch");
  lines.beginPath();
  for (const x of [-size, 0, size]) {
    lines.moveTo(x, size);
    lines.lineTo(x + size, 0);
  }
  lines.stroke();
  const pattern = context.createPattern(tile, "repeat");
  pattern.setTransform(new DOMMatrix().scale(1 / fine));
  return pattern;
}

/** Where a point of an obstacle is at `time`. */
function moved({ courses }, point, time) {
  const { start, velocity, path } = courses.findLast(({ since }) => since <= time) ?? courses[0];
  const way = path ? along(path, time) : velocity.map((speed) => speed * time);
  return point.map((x, axis) => x + start[axis] + way[axis]);
}

/** The displacement on a path at `time`: a cubic between two points, given by the velocities there. */
function along({ times, displacements, velocities }, time) {
  const next = times.findIndex((t) => time < t);
  if (next <= 0) {
    return displacements.at(next);
  }
  const last = next - 1;
  const span = times[next] - times[last];
  const [s, r] = [(time - times[last]) / span, (times[next] - time) / span];
  return displacements[last].map((from, axis) => {
    const turn = r * velocities[last][axis] - s * velocities[next][axis];
    return r * r * (1 + 2 * s) * from + s * s * (1 + 2 * r) * displacements[next][axis] + span * s * r * turn;
  });
}
