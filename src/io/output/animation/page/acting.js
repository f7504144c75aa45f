// Arrows of gravity and the magnetic field in a corner of the picture, and of remanences on the body.

/** Colours of both, and their names in the key. */
const ACTING = { g: ["gravity", "gravity"], B: ["field", "magnetic field"] };
/** Length of the longest arrow in the corner (px). */
const ACTING_LONGEST = 26;

/** From `corner` (px), the upper right one, to the left: as long as each is strong beside the largest one. */
function drawEverywhere(context, direct, moment, [right, top]) {
  everywhere.forEach((vector, k) => {
    const along = everywhereAt(moment, vector);
    const { name, largest } = vector;
    if (!(Math.hypot(...along) > 0.03 * largest)) return;
    const [dx, dy] = direct(along).map((part) => (part * ACTING_LONGEST) / largest);
    const [colour] = ACTING[name];
    const [x, y] = [right - (ACTING_LONGEST + 20) * k - ACTING_LONGEST / 2 - 6, top + ACTING_LONGEST / 2 + 6];
    drawArrow(context, [x - dx / 2, y - dy / 2], [dx, dy], colour);
    context.fillStyle = paint(colour);
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.fillText(name, x - ACTING_LONGEST / 2 - 2, y);
  });
}

function drawRemanence(context, place, moment) {
  const ends = remanenceAt(moment);
  for (let k = 0; k < ends.length; k += 2 * axes) {
    const [middle, along] = [ends.slice(k, k + axes), ends.slice(k + axes, k + 2 * axes)];
    const [from, to] = [-0.5, 0.5].map((part) => place(middle.map((x, axis) => x + part * along[axis])));
    const way = [to[0] - from[0], to[1] - from[1]];
    // what is under it is of any colour
    drawArrow(context, from, way, "push", Math.min(2, 0.1 * Math.hypot(...way)), "card");
  }
}
