// What the file holds of a motion, and the motion between its samples.

const { body, times, phases } = data;
const first = times[0];
const last = times[times.length - 1];
const axes = data.motion.ranges.length;

const places = new Uint16Array(bytes(data.motion.numbers).buffer);
const nodeCount = places.length / axes / times.length;
const quantities = data.quantities.map((quantity) => ({ ...quantity, own: quantity.scale, values: bytes(quantity.values) }));
const overTime = (series) => ({ ...series, times, values: singles(series.values) });
const energies = data.energies.map(overTime);
const sensors = data.sensors.map(overTime);
const contacts = data.contacts.map(({ at, forces }) => ({ at: singles(at), forces: singles(forces) }));
const needles = singles(data.needles);
const everywhere = data.everywhere.map(({ name, along: numbers }) => {
  const along = singles(numbers);
  const sizes = Array.from(times, (_, k) => Math.hypot(...along.subarray(k * axes, (k + 1) * axes)));
  return { name, along, largest: Math.max(...sizes) };
});
const remanence = singles(data.remanence);
const lines = data.lines.map(singles);
const springs = data.springs.map((spring) => ({ ...spring, forces: singles(spring.forces) }));

function momentAt(time) {
  return momentIn(times, time);
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

/** Value of a quantity in the cell of a face, in 255ths of the scale that is shown. */
function valueAt({ before, after, share }, { values, own, scale, signed }, face) {
  const count = body.faces.length;
  const value = between(values, before * count + face, after * count + face, share);
  return rescaled(value, own, scale, signed);
}

/** Force of the actuator of a spring (N): that of the sample at hand or, between two, of the next. */
function actuationAt({ before, after, share }, { forces }) {
  return forces[share > 0 ? after : before];
}

/** Places (m) and directions of the needles of devices, one after the other. */
function needlesAt(moment) {
  return arrayAt(needles, moment);
}

/** Gravity (m/s^2) or the magnetic field (T): between two samples from one to the next if both are in the same phase. */
function everywhereAt({ before, after, share, time }, { along }) {
  const from = phaseAt(times[before]) === phaseAt(time) ? before : after;
  return Array.from({ length: axes }, (_, axis) => between(along, from * axes + axis, after * axes + axis, share));
}

/** The middle of each arrow on magnets, and the arrow (m), one after the other. */
function remanenceAt(moment) {
  return arrayAt(remanence, moment);
}

/** Numbers of which each sample has as many, one after the other. */
function arrayAt(values, { before, after, share }) {
  const count = values.length / times.length;
  return Array.from({ length: count }, (_, k) => between(values, before * count + k, after * count + k, share));
}

/** The ends of the lines along which surfaces of liquids meet walls (m), at the sample at hand or, between two, at the next. */
function linesAt({ before, after, share }) {
  return lines[share > 0 ? after : before] ?? [];
}

/** The phase at `time`; its end belongs to it. */
function phaseAt(time) {
  return phases.find((phase) => time <= phase.end) ?? phases[phases.length - 1];
}
