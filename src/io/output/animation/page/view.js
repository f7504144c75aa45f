// The part of space that pictures show, and from where.

/** Directions of sight of bodies in space. */
const view = { azimuth: Math.PI / 6, elevation: Math.PI / 9 };

/** Middle of the box between two corners, and half of its diagonal. */
function ball([low, high]) {
  return [
    low.map((least, axis) => (least + high[axis]) / 2),
    Math.hypot(...low.map((least, axis) => (high[axis] - least) / 2)) || 1,
  ];
}

/** Corners of a box around boxes. */
function united(boxes) {
  return boxes.reduce(([low, high], [least, largest]) => [
    low.map((x, axis) => Math.min(x, least[axis])),
    high.map((x, axis) => Math.max(x, largest[axis])),
  ]);
}

/** Corners of a box around a motion in space and the obstacles that are near it. */
function around({ motion: { ranges }, obstacles }) {
  const whole = [ranges.map(([least]) => least), ranges.map(([, largest]) => largest)];
  const [centre, half] = ball(whole);
  const near = obstacles.flatMap(({ centre: at, from = at, to = at, radius = 0, min, max }) => {
    const [low, high] = [min ?? from, max ?? to];
    if (!low || Math.hypot(...low.map((x, axis) => (x + high[axis]) / 2 - centre[axis])) > 2 * half) return [];
    const least = low.map((x, axis) => Math.min(x, high[axis]) - radius);
    const largest = low.map((x, axis) => Math.max(x, high[axis]) + radius);
    return [[least, largest]];
  });
  return united([whole, ...near]);
}
