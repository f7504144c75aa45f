// What the file holds, and the motion between its samples.

const data = JSON.parse(document.getElementById("data").textContent);
const { body, times, phases } = data;
const first = times[0];
const last = times[times.length - 1];
const axes = data.motion.ranges.length;

const places = new Uint16Array(bytes(data.motion.numbers).buffer);
const nodeCount = places.length / axes / times.length;
const quantities = data.quantities.map((quantity) => ({
  ...quantity,
  values: bytes(quantity.values),
}));
const energies = data.energies
  .map((series) => ({ ...series, values: singles(series.values) }))
  .filter((series) => series.values.some((value) => value !== 0));
const sensors = data.sensors.map((sensor) => ({ ...sensor, values: singles(sensor.values) }));
const contacts = data.contacts.map(({ at, forces }) => ({ at: singles(at), forces: singles(forces) }));
const springs = data.springs.map((spring) => ({ ...spring, forces: singles(spring.forces) }));

/** The samples before and after `time`, and how far it is from one to the other. */
function momentAt(time) {
  let before = 0;
  let after = times.length - 1;
  while (after - before > 1) {
    const middle = (before + after) >> 1;
    if (times[middle] <= time) before = middle;
    else after = middle;
  }
  const span = times[after] - times[before];
  const share = span > 0 ? Math.min(Math.max((time - times[before]) / span, 0), 1) : 0;
  return { time, before, after, share };
}

function between(values, from, to, share) {
  return values[from] + (values[to] - values[from]) * share;
}

/** Positions of all drawn nodes (m), axis by axis. */
function positionsAt({ before, after, share }) {
  return data.motion.ranges.map(([least, largest], axis) => {
    const step = (largest - least) / 65535;
    const along = new Float64Array(nodeCount);
    let from = before * nodeCount * axes + axis;
    let to = after * nodeCount * axes + axis;
    for (let node = 0; node < nodeCount; node++, from += axes, to += axes) {
      along[node] = least + step * between(places, from, to, share);
    }
    return along;
  });
}

/** Value of a quantity in the cell of a face, in 255ths of its scale. */
function valueAt({ before, after, share }, { values }, face) {
  const count = body.faces.length;
  return between(values, before * count + face, after * count + face, share);
}

/** A number over time; at a sample its own, whatever is beside it. */
function seriesAt({ before, after, share }, { values }) {
  if (share === 0 || share === 1) return values[share === 0 ? before : after];
  return between(values, before, after, share);
}

/** Force of the actuator of a spring (N): that of the sample at hand or, between two, of the next. */
function actuationAt({ before, after, share }, { forces }) {
  return forces[share > 0 ? after : before];
}

/** The phase at `time`; its end belongs to it. */
function phaseAt(time) {
  return phases.find((phase) => time <= phase.end) ?? phases[phases.length - 1];
}
