// Bodies in the plane: bars, strings, areas.

/** Number of the body that a face belongs to. */
const bodyOf = body.bodies.flatMap(({ faces }, number) => Array(faces).fill(number));
const lookOf = (face) => body.bodies[bodyOf[face]].look;

/** Where no quantity is shown, bodies differ by their colours: six, then over again. */
function plainColours() {
  return body.bodies.map((_, number) => paint(number % 6 ? `plain${number % 6}` : "plain"));
}

const upright = body.bodies.some(({ look }) => look === "bar");
const MARGIN = { left: 46, right: 12, top: 10, bottom: upright ? 12 : 40 };
/** Width of a bar as drawn (m): enough to be seen, for a bar has none of its own. */
const barWidth = upright ? Math.max(body.width, 0.1 * (data.view[1][1] - data.view[0][1])) : 0;

/** What the margins leave of a sheet (px). */
function roomOn(width, height) {
  return [width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
}

/** Pixels per metre with which the view fills `room`. */
function fitView(room) {
  const [low, high] = data.view;
  return Math.min(...room.map((size, axis) => size / (high[axis] - low[axis])));
}

/** Where points of the plane (m) are on a sheet (px). */
function layOut({ width, height }) {
  const [[low, bottom], [high, top]] = data.view;
  const room = roomOn(width, height);
  const pixels = scale();
  const middle = [(low + high) / 2, (bottom + top) / 2];
  const centre = [MARGIN.left + room[0] / 2, MARGIN.top + room[1] / 2];
  return {
    scale: pixels,
    room,
    low: [middle[0] - room[0] / pixels / 2, middle[1] - room[1] / pixels / 2],
    high: [middle[0] + room[0] / pixels / 2, middle[1] + room[1] / pixels / 2],
    x: (x) => centre[0] + (x - middle[0]) * pixels,
    y: (y) => centre[1] - (y - middle[1]) * pixels,
  };
}

function drawPlane(sheet, moment, quantity) {
  const { context } = sheet;
  const layout = layOut(sheet);
  drawAxes(context, layout);
  context.save();
  context.beginPath();
  context.rect(MARGIN.left, MARGIN.top, ...layout.room);
  context.clip();
  const hatch = sheet.hatching();
  for (const obstacle of data.obstacles) drawObstacle(context, layout, obstacle, moment.time, hatch);
  const [xs, ys] = positionsAt(moment);
  const points = { xs: xs.map(layout.x), ys: ys.map(layout.y) };
  drawBody(context, layout, points, moment, quantity);
  drawLines(context, ([x, y]) => [layout.x(x), layout.y(y)], moment);
  drawSprings(context, points, moment);
  drawMarks(context, points, phaseAt(moment.time), () => true);
  const place = ([x, y]) => [layout.x(x), layout.y(y)];
  const direct = ([x, y]) => [x, -y];
  drawRemanence(context, place, moment);
  drawNeedles(context, place, direct, moment);
  drawEverywhere(context, direct, moment, [MARGIN.left + layout.room[0], MARGIN.top]);
  context.restore();
}

/** Lines and lengths along the edges: a ruler for the picture. */
function drawAxes(context, layout) {
  const { low, high, room } = layout;
  const { factor, unit } = lengthUnit(Math.max(high[0] - low[0], high[1] - low[1]));
  const right = MARGIN.left + room[0];
  const floor = MARGIN.top + room[1];
  context.fillStyle = paint("muted");
  context.strokeStyle = paint("grid");
  context.lineWidth = 1;
  const wanted = Math.max(2, Math.min(room[0] / 90, 8));
  const { step } = ticks(low[0] / factor, high[0] / factor, wanted);
  const marks = (axis) => ticks(low[axis] / factor, high[axis] / factor,
    (high[axis] - low[axis]) / factor / step);
  context.beginPath();
  if (!upright) {
    const along = marks(0);
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const value of along.values) {
      const x = layout.x(value * factor);
      context.moveTo(x, MARGIN.top);
      context.lineTo(x, floor);
      context.fillText(fixed(value, along.decimals), x, floor + 7);
    }
    context.fillText(`x (${unit})`, MARGIN.left + room[0] / 2, floor + 23);
  }
  const upward = marks(1);
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const value of upward.values) {
    const y = layout.y(value * factor);
    context.moveTo(MARGIN.left, y);
    context.lineTo(right, y);
    if (y > MARGIN.top + 18) context.fillText(fixed(value, upward.decimals), MARGIN.left - 7, y);
  }
  context.fillText(upright ? unit : `y (${unit})`, MARGIN.left - 7, MARGIN.top + 5);
  context.stroke();
}

/** Fills what is solid and strokes its surface; `trace` makes the path. */
function drawSolid(context, hatch, trace) {
  context.beginPath();
  trace();
  context.fillStyle = hatch;
  context.fill("evenodd");
  context.strokeStyle = paint("muted");
  context.lineWidth = 1.5;
  context.stroke();
}

function drawObstacle(context, layout, obstacle, time, hatch) {
  const at = (point) => {
    const [x, y] = moved(obstacle, point, time);
    return [layout.x(x), layout.y(y)];
  };
  const far = 2 * Math.hypot(...layout.room) + 100;
  const circle = () => context.arc(...at(obstacle.centre), obstacle.radius * layout.scale, 0, 7);
  if (obstacle.kind === "half-plane") {
    // the point of its surface next to the middle of the picture, however far its own is
    const [nx, ny] = obstacle.normal;
    const [x, y] = at(obstacle.point);
    const length = Math.hypot(nx, ny);
    const middle = [MARGIN.left + layout.room[0] / 2, MARGIN.top + layout.room[1] / 2];
    const [tx, ty] = [ny / length, nx / length];
    const along = (middle[0] - x) * tx + (middle[1] - y) * ty;
    context.save();
    context.translate(x + along * tx, y + along * ty);
    context.rotate(Math.atan2(nx, ny));
    drawSolid(context, hatch, () => context.rect(-far, 0, 2 * far, far));
    context.restore();
  } else if (obstacle.kind === "disc") {
    drawSolid(context, hatch, circle);
  } else if (obstacle.kind === "cavity") {
    drawSolid(context, hatch, () => {
      context.rect(-far, -far, 4 * far, 4 * far);
      context.moveTo(...at([obstacle.centre[0] + obstacle.radius, obstacle.centre[1]]));
      circle();
    });
  } else if (obstacle.corners) {
    drawSolid(context, hatch, () => tracePolygon(context, [0, 1, 3, 2].map((k) => at(obstacle.corners[k]))));
  } else if (obstacle.kind === "box") {
    // in one dimension a box has no width of its own either
    const [left, low] = at([obstacle.min[0] - barWidth, obstacle.min[1]]);
    const [right, high] = at([obstacle.max[0] + barWidth, obstacle.max[1]]);
    drawSolid(context, hatch, () => context.rect(left, high, right - left, low - high));
  } else {
    const [from, to] = [at(obstacle.from), at(obstacle.to)];
    const radius = obstacle.radius * layout.scale;
    const across = Math.atan2(to[1] - from[1], to[0] - from[0]) + Math.PI / 2;
    drawSolid(context, hatch, () => {
      context.arc(...from, radius, across, across + Math.PI);
      context.arc(...to, radius, across + Math.PI, across);
      context.closePath();
    });
  }
}

function drawBody(context, layout, points, moment, quantity) {
  const plain = plainColours();
  context.lineWidth = 1;
  body.faces.forEach((face, index) => {
    const colour = quantity
      ? rgb(colours[Math.round(valueAt(moment, quantity, index))])
      : plain[bodyOf[index]];
    context.beginPath();
    traceFace(context, layout, points, face);
    // the stroke closes the seams that smooth edges leave
    context.fillStyle = context.strokeStyle = colour;
    if (lookOf(index) === "string") drawThread(context, colour);
    else {
      context.fill();
      context.stroke();
    }
  });
  if (body.bodies.every(({ look }) => look === "string")) return;
  const spacing = upright ? 20 : spacingOf(points);
  if (spacing > 4) {
    // edges of dark cells are light, those of light cells dark
    for (const light of [true, false]) {
      context.beginPath();
      body.faces.forEach((face, index) => {
        if (lookOf(index) === "string") return;
        const dark = quantity !== undefined && valueAt(moment, quantity, index) < 150;
        if (dark === light) traceFace(context, layout, points, face);
      });
      strokeEdges(context, spacing, light);
    }
  }
  context.strokeStyle = paint("edge");
  context.lineWidth = 1.5;
  context.beginPath();
  for (const edge of body.outline) traceEdge(context, points, edge, true);
  context.stroke();
}

/** About how far apart nodes are drawn (px). */
function spacingOf({ xs, ys }) {
  const extent = (along) => {
    let [least, largest] = [Infinity, -Infinity];
    for (const x of along) {
      least = Math.min(least, x);
      largest = Math.max(largest, x);
    }
    return largest - least;
  };
  return Math.sqrt((extent(xs) * extent(ys)) / body.faces.length);
}

/** Strokes a path of edges between cells, finer in finer meshes. */
function strokeEdges(context, spacing, light) {
  context.strokeStyle = light ? "#fff" : "#000";
  context.globalAlpha = (light ? 0.4 : 0.3) * Math.min(1, spacing / 16);
  context.lineWidth = Math.min(Math.max(0.04 * spacing, 0.5), 1);
  context.stroke();
  context.globalAlpha = 1;
}

function drawThread(context, colour) {
  context.lineCap = "round";
  context.lineWidth = 6;
  context.strokeStyle = paint("edge");
  context.stroke();
  context.lineWidth = 4;
  context.strokeStyle = colour;
  context.stroke();
}

/** Adds a face to the path. */
function traceFace(context, layout, points, face) {
  const { xs, ys } = points;
  if (upright) {
    const half = (barWidth * layout.scale) / 2;
    const [top, bottom] = [ys[face[0]], ys[face[1]]];
    context.rect(xs[face[0]] - half, top, 2 * half, bottom - top);
    return;
  }
  context.moveTo(xs[face[0]], ys[face[0]]);
  if (face.length > 4) {
    for (let k = 0; k < face.length; k += 2) {
      traceEdge(context, points, [face[k], face[k + 1], face[(k + 2) % face.length]], false);
    }
  } else {
    for (let k = 1; k < face.length; k++) context.lineTo(xs[face[k]], ys[face[k]]);
  }
  if (face.length > 2) context.closePath();
}

/** Adds an edge to the path: a line or, through a mid node, the parabola that it is. */
function traceEdge(context, { xs, ys }, edge, starts) {
  const from = edge[0];
  const to = edge[edge.length - 1];
  if (starts) context.moveTo(xs[from], ys[from]);
  if (edge.length === 2) {
    context.lineTo(xs[to], ys[to]);
    return;
  }
  const control = (along) => 2 * along[edge[1]] - (along[from] + along[to]) / 2;
  context.quadraticCurveTo(control(xs), control(ys), xs[to], ys[to]);
}

/** Springs as zigzag lines and cables as straight ones, in colour while their actuators pull or push. */
function drawSprings(context, { xs, ys }, moment) {
  const TURNS = 11;
  context.lineWidth = 1.6;
  for (const spring of springs) {
    const force = actuationAt(moment, spring);
    context.strokeStyle = paint(driven(spring, force));
    if (spring.isCable) {
      context.beginPath();
      for (const place of spring.ends) context.lineTo(xs[place], ys[place]);
      context.stroke();
      continue;
    }
    const [a, b] = spring.ends;
    const [dx, dy] = [xs[b] - xs[a], ys[b] - ys[a]];
    const length = Math.hypot(dx, dy) || 1;
    const swing = Math.min(6, 0.1 * length + 1) / length;
    context.beginPath();
    context.moveTo(xs[a], ys[a]);
    for (let k = 0; k <= TURNS; k++) {
      const along = 0.2 + (0.6 * k) / TURNS;
      const across = k === 0 || k === TURNS ? 0 : k % 2 ? swing : -swing;
      context.lineTo(xs[a] + along * dx - across * dy, ys[a] + along * dy + across * dx);
    }
    context.lineTo(xs[b], ys[b]);
    context.stroke();
  }
}

/** The colour of a spring or a cable that is driven by a force. */
function driven(spring, force) {
  if (force === 0 || (spring.isCable && force < 0)) return "spring";
  return spring.isCable || force < 0 ? "pull" : "push";
}

/** Held nodes, moved nodes and point masses, those that `shows` lets through. */
function drawMarks(context, { xs, ys }, phase, shows) {
  const radius = Math.min(4, Math.max(1.5, 60 / Math.sqrt(nodeCount)));
  const dot = (node, radius, colour) => {
    if (!shows(node)) return;
    context.beginPath();
    context.arc(xs[node], ys[node], radius, 0, 7);
    context.fillStyle = paint(colour);
    context.strokeStyle = paint("card");
    context.lineWidth = 1;
    context.fill();
    context.stroke();
  };
  for (const node of data.points) dot(node, 6, "ink");
  for (const node of phase.held) dot(node, radius, "ink");
  for (const node of phase.moved) dot(node, radius + 0.5, "moved");
}
