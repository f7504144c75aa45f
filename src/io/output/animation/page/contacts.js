// Forces of the obstacles on the body, where they act.

/** The largest of them (N). */
const strongest = Math.max(0, ...contacts.flatMap(({ forces }) =>
  Array.from(times, (_, k) => Math.hypot(...forces.subarray(k * axes, (k + 1) * axes)))));

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

/** As arrows, of which one of `forceOfLongest` (N) is the longest. */
function drawContacts(sheet, moment, forceOfLongest) {
  const { context } = sheet;
  const eye = inSpace ? look(sheet) : layOut(sheet);
  const place = inSpace ? eye.place : ([x, y]) => [eye.x(x), eye.y(y)];
  const direct = inSpace ? (f) => [dot(eye.right, f), -dot(eye.up, f)] : ([x, y]) => [x, -y];
  for (const contact of contacts) {
    const { force, at } = resultantAt(moment, contact);
    if (!at) continue;
    const [dx, dy] = direct(force).map((part) => (part * LONGEST) / forceOfLongest);
    drawArrow(context, place(at), [dx, dy], "contact");
  }
}
