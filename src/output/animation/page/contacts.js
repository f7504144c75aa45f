// Forces of the obstacles on the body, as arrows where they act.

const arrows = document.getElementById("arrows");
/** Length of the longest arrow at most (px), and the force that is as long: a round number. */
const LONGEST = 80;
const strongest = Math.max(0, ...contacts.flatMap(({ forces }) =>
  Array.from(times, (_, k) => Math.hypot(...forces.subarray(k * axes, (k + 1) * axes)))));
const forceOfLongest = [1, 2, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10(strongest || 1)))
  .find((force) => force >= 0.999 * strongest);

/** Force (N) of an obstacle at a moment, and where it acts: between two samples in proportion to their forces. */
function resultantAt({ before, after, share }, { at, forces }) {
  const ends = [[before, 1 - share], [after, share]].map(([k, weight]) => {
    const part = (values) => Array.from(values.subarray(k * axes, (k + 1) * axes));
    const force = part(forces);
    return { force: force.map((f) => weight * f), at: part(at), size: weight * Math.hypot(...force) };
  });
  const size = ends[0].size + ends[1].size;
  const sum = (value) => Array.from({ length: axes }, (_, axis) => value(ends[0], axis) + value(ends[1], axis));
  return {
    force: sum((end, axis) => end.force[axis]),
    at: size > 0 ? sum((end, axis) => (end.size / size) * end.at[axis]) : null,
  };
}

function drawContacts(sheet, moment) {
  const { context } = sheet;
  const eye = inSpace ? look(sheet) : layOut(sheet);
  const place = inSpace ? eye.place : ([x, y]) => [eye.x(x), eye.y(y)];
  const direct = inSpace ? (f) => [dot(eye.right, f), -dot(eye.up, f)] : ([x, y]) => [x, -y];
  for (const contact of contacts) {
    const { force, at } = resultantAt(moment, contact);
    if (!at) continue;
    const [dx, dy] = direct(force).map((part) => (part * LONGEST) / forceOfLongest);
    drawArrow(context, place(at), [dx, dy]);
  }
}

function drawArrow(context, [x, y], [dx, dy]) {
  const length = Math.hypot(dx, dy);
  if (length < 1) return;
  const head = Math.min(9, 0.6 * length);
  const [tx, ty] = [dx / length, dy / length];
  context.strokeStyle = context.fillStyle = paint("contact");
  context.lineWidth = 2.5;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + dx - head * tx, y + dy - head * ty);
  context.stroke();
  context.beginPath();
  context.moveTo(x + dx, y + dy);
  context.lineTo(x + dx - head * tx - 0.45 * head * ty, y + dy - head * ty + 0.45 * head * tx);
  context.lineTo(x + dx - head * tx + 0.45 * head * ty, y + dy - head * ty - 0.45 * head * tx);
  context.closePath();
  context.fill();
}

/** The box to tick, if there are contacts, and how long arrows are; `redraw` is called after a tick. */
function offerContacts(redraw) {
  document.getElementById("contacts").hidden = contacts.length === 0;
  const legend = document.getElementById("newtons");
  const { factor, unit } = prefixed(forceOfLongest, "N");
  legend.append(`= ${number(forceOfLongest / factor)} ${unit}`);
  arrows.addEventListener("change", () => {
    legend.hidden = !arrows.checked;
    redraw();
  });
}
