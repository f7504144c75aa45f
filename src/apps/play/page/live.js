// The motion as it happens: what the pages of recorded motions read from their file comes from the simulation.

const data = JSON.parse(document.getElementById("data").textContent);
const { body, phases, axes } = data;
let places = singles(data.start);
const nodeCount = places.length / axes;
/** Places (m) and directions of the needles of devices, one after the other. */
let needles = singles(data.needles);

/** From the least to the largest coordinate of the drawn nodes, and of needles less than two sizes of the body away, axis by axis (m). */
function extent() {
  const ranges = Array.from({ length: axes }, () => [Infinity, -Infinity]);
  places.forEach((x, k) => {
    const range = ranges[k % axes];
    range[0] = Math.min(range[0], x);
    range[1] = Math.max(range[1], x);
  });
  const centre = ranges.map(([least, largest]) => (least + largest) / 2);
  const far = 2 * Math.hypot(...ranges.map(([least, largest]) => largest - least));
  for (let start = 0; start < needles.length; start += 2 * axes) {
    const at = Array.from(needles.slice(start, start + axes));
    if (Math.hypot(...at.map((x, axis) => x - centre[axis])) > far) continue;
    at.forEach((x, axis) => {
      ranges[axis] = [Math.min(ranges[axis][0], x), Math.max(ranges[axis][1], x)];
    });
  }
  return ranges;
}

/** Room around the body, in parts of its size. */
const ROOM = 0.35;

/** The part of space that is shown, for a body with room to move. */
function roomy(ranges) {
  const size = Math.max(...ranges.map(([least, largest]) => largest - least)) || 1;
  return ranges.map(([least, largest]) => [least - ROOM * size, largest + ROOM * size]);
}

function corners([across, upward]) {
  return [[across[0], upward[0]], [across[1], upward[1]]];
}

data.motion = { ranges: roomy(extent()) };
data.view = axes === 2 ? corners(data.motion.ranges) : around(data);

const figure = document.querySelector("figure");
/** Pixels per metre of the picture. */
const scale = () => fitting();

/** Shows more if the body leaves the part of the plane that is shown. Returns whether it did. */
function follow() {
  if (axes !== 2) return false;
  const [low, high] = data.view;
  let grew = false;
  extent().forEach(([least, largest], axis) => {
    const pad = 0.1 * (largest - least);
    if (!Number.isFinite(pad) || (least >= low[axis] && largest <= high[axis])) return;
    low[axis] = Math.min(low[axis], least - pad);
    high[axis] = Math.max(high[axis], largest + pad);
    grew = true;
  });
  return grew;
}

const times = [];
let first = 0;
let last = 0;
const energies = data.energies
  .map((name, number) => ({ name, number, times, values: [] }))
  .filter(({ name }) => !data.absent.includes(name));
const sensors = data.sensors.map((sensor, number) => ({ ...sensor, number, times, values: [] }));
// scales grow with what is seen
const quantities = data.quantities.map((quantity) => ({ ...quantity, scale: 0, peak: 0 }));
// marks are explained as soon as an actuator can act
const springs = data.springs.map((spring) => ({ ...spring, forces: [-1, 1] }));
/** Gravity and the magnetic field, with the largest size of each that was seen. */
const everywhere = data.everywhere.map((name) => ({ name, largest: 0 }));
/** The number of arrows on magnets: the key asks whether there are any. */
const remanence = { length: data.arrows };
/** The present, as the simulation told it last. */
let frame = { time: 0, phase: 0, actuations: springs.map(() => 0), lines: "", everywhere: [], remanence: "", colours: null };
let colouring = new Uint8Array(0);

/** Points of the chart at most. */
const MOST_POINTS = 1500;

/** Takes up what the simulation tells. */
function take(next) {
  if (next.time < last) forget();
  frame = next;
  places = singles(next.places);
  needles = singles(next.needles);
  for (const vector of everywhere) vector.largest = Math.max(vector.largest, Math.hypot(...everywhereAt(null, vector)));
  if (next.colours) {
    colouring = bytes(next.colours.values);
    const shown = quantities[next.colours.quantity];
    shown.scale = Math.max(shown.scale, next.colours.scale);
  }
  for (const [time, told, read] of next.past) {
    times.push(time);
    last = time;
    for (const { number, values } of energies) values.push(told[number]);
    for (const { number, values } of sensors) values.push(read[number] ?? NaN);
  }
  if (times.length > MOST_POINTS) {
    const thin = (list) => list.splice(0, list.length, ...list.filter((_, k) => k % 2 === 0));
    thin(times);
    for (const { values } of [...energies, ...sensors]) thin(values);
  }
}

function forget() {
  last = 0;
  times.length = 0;
  for (const { values } of [...energies, ...sensors]) values.length = 0;
  for (const quantity of quantities) quantity.scale = 0;
}

function positionsAt() {
  return Array.from({ length: axes }, (_, axis) =>
    Float64Array.from({ length: nodeCount }, (_, node) => places[node * axes + axis]));
}

/** Value of the chosen quantity in the cell of a face, in 255ths of its scale. */
function valueAt(_, { scale, signed }, face) {
  return rescaled(colouring[face], frame.colours?.scale ?? 0, scale, signed) || 0;
}

function seriesAt(_, { values }) {
  return values[values.length - 1] ?? 0;
}

/** Force of the actuator of a spring (N). */
function actuationAt(_, spring) {
  return frame.actuations[springs.indexOf(spring)];
}

function needlesAt() {
  return needles;
}

/** Gravity (m/s^2) or the magnetic field (T). */
function everywhereAt(_, { name }) {
  return frame.everywhere[name === "g" ? 0 : 1] ?? [];
}

/** The middle of each arrow on magnets, and the arrow (m), one after the other. */
function remanenceAt() {
  return Array.from(singles(frame.remanence));
}

/** The ends of the lines along which surfaces of liquids meet walls (m). */
function linesAt() {
  return singles(frame.lines);
}

function phaseAt() {
  return phases[frame.phase];
}
