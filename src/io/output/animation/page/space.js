// Bodies in space, seen from far away (all lines of sight parallel), to be turned by hand.

const allSolid = body.bodies.every(({ look }) => look === "solid");

const LIGHT = [-0.35, -0.55, 0.76];
const [middle, radius] = ball(data.view);

/** Pixels per metre with which the ball around the view fills a sheet. */
function fitBall(width, height) {
  return (0.54 * Math.min(width, height)) / radius;
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Directions to the right, upward and away from the viewer, and where points are on a sheet. */
function look({ width, height }) {
  const [ca, sa] = [Math.cos(view.azimuth), Math.sin(view.azimuth)];
  const [ce, se] = [Math.cos(view.elevation), Math.sin(view.elevation)];
  const right = [ca, sa, 0];
  const up = [-se * sa, se * ca, ce];
  const away = [-ce * sa, ce * ca, -se];
  const pixels = scale();
  const from = (x) => [x[0] - middle[0], x[1] - middle[1], x[2] - middle[2]];
  return {
    right,
    up,
    away,
    scale: pixels,
    place: (x) => {
      const arm = from(x);
      return [width / 2 + pixels * dot(right, arm), height / 2 - pixels * dot(up, arm)];
    },
    depth: (x) => dot(away, from(x)),
  };
}

function drawSpace(sheet, moment, quantity) {
  const { context } = sheet;
  const eye = look(sheet);
  const along = positionsAt(moment);
  const position = (node) => [along[0][node], along[1][node], along[2][node]];
  const points = { xs: new Float64Array(nodeCount), ys: new Float64Array(nodeCount) };
  let depth = 0;
  for (let node = 0; node < nodeCount; node++) {
    [points.xs[node], points.ys[node]] = eye.place(position(node));
    depth += eye.depth(position(node)) / nodeCount;
  }
  const obstacles = data.obstacles.map((obstacle) => obstacleInSpace(obstacle, eye, moment.time));
  obstacles.sort((a, b) => b.depth - a.depth);
  for (const obstacle of obstacles) if (obstacle.depth >= depth) obstacle.draw(context, 1);
  const seen = drawSurface(context, eye, points, position, moment, quantity);
  drawLines(context, eye.place, moment);
  drawSprings(context, points, moment);
  drawMarks(context, points, phaseAt(moment.time), (node) => seen[node]);
  for (const obstacle of obstacles) if (obstacle.depth < depth) obstacle.draw(context, 0.45);
  const direct = (m) => [dot(eye.right, m), -dot(eye.up, m)];
  drawRemanence(context, eye.place, moment);
  drawNeedles(context, eye.place, direct, moment);
  drawEverywhere(context, direct, moment, [sheet.width - 8, 8]);
  drawTriad(sheet, eye);
}

/** Draws the faces, what is far away first, and returns which nodes are on faces that are seen. */
function drawSurface(context, eye, points, position, moment, quantity) {
  const { xs, ys } = points;
  const seen = new Uint8Array(nodeCount).fill(allSolid ? 0 : 1);
  const faces = [];
  body.faces.forEach((face, index) => {
    const corners = face.length > 4 ? face.filter((_, k) => k % 2 === 0) : face;
    const [a, b] = [corners[0], corners[1]];
    const c = corners[corners.length - 1];
    const turn = (xs[b] - xs[a]) * (ys[c] - ys[a]) - (ys[b] - ys[a]) * (xs[c] - xs[a]);
    // faces of a solid run counter-clockwise as seen from outside; the sheet's y points down
    const solid = lookOf(index) === "solid";
    if (solid && turn >= 0) return;
    for (const node of face) seen[node] = 1;
    const depth = corners.reduce((sum, node) => sum + eye.depth(position(node)), 0);
    const bright = brightness(solid, ...[a, b, c].map(position));
    faces.push({ face, index, depth: depth / corners.length, bright });
  });
  faces.sort((a, b) => b.depth - a.depth);
  const spacing = spacingOf(points) * (allSolid ? Math.SQRT2 : 1);
  const plain = plainColours();
  for (const { face, index, bright } of faces) {
    context.beginPath();
    traceFace(context, eye, points, face);
    const value = quantity && Math.round(valueAt(moment, quantity, index));
    const colour = quantity ? rgb(colours[value], bright) : plain[bodyOf[index]];
    context.fillStyle = context.strokeStyle = colour;
    if (lookOf(index) === "string") {
      drawThread(context, colour);
      continue;
    }
    context.lineWidth = 1;
    context.fill();
    context.stroke();
    if (spacing > 4) strokeEdges(context, spacing, quantity !== undefined && value < 150);
  }
  return seen;
}

/** A face that looks at the light is a little brighter, either side of it. */
function brightness(solid, a, b, c) {
  const [p, q] = [b, c].map((x) => [x[0] - a[0], x[1] - a[1], x[2] - a[2]]);
  const normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
  const cosine = dot(normal, LIGHT) / (Math.hypot(...normal) * Math.hypot(...LIGHT) || 1);
  return 0.86 + 0.14 * (solid ? cosine : Math.abs(cosine));
}

/** How to draw an obstacle at `time`, and how far away it is. */
function obstacleInSpace(obstacle, eye, time) {
  const at = (point) => moved(obstacle, point, time);
  const ball = (centre, radius) => ({
    depth: eye.depth(centre),
    trace: (context) => context.arc(...eye.place(centre), radius * eye.scale, 0, 7),
  });
  const solid = {
    "half-plane": () => patch(at(obstacle.point), obstacle.normal, eye),
    disc: () => ball(at(obstacle.centre), obstacle.radius),
    // around everything: its outline alone
    cavity: () => ({ ...ball(at(obstacle.centre), obstacle.radius), depth: Infinity, open: true }),
    box: () => boxInSpace(cornersOf(obstacle).map(at), eye),
    capsule: () => capsuleInSpace(at(obstacle.from), at(obstacle.to), obstacle.radius, eye),
  }[obstacle.kind]();
  const draw = (context, opacity) => {
    context.beginPath();
    solid.trace(context);
    context.fillStyle = paint(obstacle.kind === "half-plane" ? "solid" : "hatch");
    context.strokeStyle = paint("muted");
    context.lineWidth = 0.75;
    context.globalAlpha = opacity;
    if (!solid.open) context.fill();
    context.globalAlpha = 0.6 * opacity;
    context.stroke();
    context.globalAlpha = 1;
  };
  return { depth: solid.depth, draw };
}

/** A squared piece of the plane under the motion; the plane is behind it if it is seen from outside. */
function patch(point, normal, eye) {
  const length = Math.hypot(...normal);
  const n = normal.map((x) => x / length);
  const height = dot(n, middle) - dot(n, point);
  const foot = middle.map((x, axis) => x - height * n[axis]);
  const least = n.map(Math.abs).indexOf(Math.min(...n.map(Math.abs)));
  const first = [0, 1, 2].map((axis) => (axis === least ? 1 : 0) - n[least] * n[axis]);
  const size = Math.hypot(...first);
  const p = first.map((x) => x / size);
  const q = [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]];
  const spot = (a, b) => eye.place(foot.map((x, axis) => x + radius * (a * p[axis] + b * q[axis])));
  return {
    depth: dot(n, eye.away) < 0 ? Infinity : -Infinity,
    trace: (context) => {
      const lines = [-1, -0.75, -0.5, -0.25, 0, 0.25, 0.5, 0.75, 1];
      const corners = [spot(-1, -1), spot(1, -1), spot(1, 1), spot(-1, 1)];
      tracePolygon(context, corners);
      for (const k of lines.slice(1, -1)) {
        tracePolygon(context, [spot(k, -1), spot(k, 1)]);
        tracePolygon(context, [spot(-1, k), spot(1, k)]);
      }
    },
  };
}

/** The corners of a box: at the digits 1 of their binary numbers they are at the upper ends of its edges. */
function cornersOf({ corners, min, max }) {
  const corner = (k) => [0, 1, 2].map((axis) => ((k >> axis) & 1 ? max : min)[axis]);
  return corners ?? [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
}

function boxInSpace(corners, eye) {
  const along = (axis) => corners[1 << axis].map((x, i) => x - corners[0][i]);
  // the three faces at the corner next to the viewer, which hide the others
  const near = [0, 1, 2].reduce((k, axis) => k | (dot(eye.away, along(axis)) < 0 ? 1 << axis : 0), 0);
  const faces = [0, 1, 2].map((axis) => {
    const [u, v] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
    return [near, near ^ u, near ^ u ^ v, near ^ v].map((k) => eye.place(corners[k]));
  });
  return {
    depth: eye.depth(corners[0].map((x, axis) => (x + corners[7][axis]) / 2)),
    trace: (context) => faces.forEach((face) => tracePolygon(context, face)),
  };
}

function capsuleInSpace(from, to, radius, eye) {
  const [[ax, ay], [bx, by]] = [eye.place(from), eye.place(to)];
  const across = Math.atan2(by - ay, bx - ax) + Math.PI / 2;
  return {
    depth: eye.depth(from.map((x, axis) => (x + to[axis]) / 2)),
    trace: (context) => {
      context.arc(ax, ay, radius * eye.scale, across, across + Math.PI);
      context.arc(bx, by, radius * eye.scale, across + Math.PI, across);
      context.closePath();
    },
  };
}

function tracePolygon(context, corners) {
  corners.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
}

/** The directions of the axes, and a length. */
function drawTriad({ context, width, height }, eye) {
  const centre = [34, height - 34];
  context.strokeStyle = context.fillStyle = paint("muted");
  context.lineWidth = 1.5;
  context.textAlign = "center";
  context.textBaseline = "middle";
  ["x", "y", "z"].forEach((name, axis) => {
    const [x, y] = [eye.right[axis], -eye.up[axis]];
    context.beginPath();
    context.moveTo(...centre);
    context.lineTo(centre[0] + 20 * x, centre[1] + 20 * y);
    context.stroke();
    context.fillText(name, centre[0] + 28 * x, centre[1] + 28 * y);
  });
  const { factor, unit } = lengthUnit(width / eye.scale);
  const { step, decimals } = ticks(0, (0.25 * width) / eye.scale / factor, 1);
  const length = step * factor * eye.scale;
  const [left, low] = [width - 14 - length, height - 14];
  context.beginPath();
  context.moveTo(left, low - 4);
  context.lineTo(left, low);
  context.lineTo(left + length, low);
  context.lineTo(left + length, low - 4);
  context.stroke();
  context.textBaseline = "bottom";
  context.fillText(`${fixed(step, decimals)} ${unit}`, left + length / 2, low - 5);
}
