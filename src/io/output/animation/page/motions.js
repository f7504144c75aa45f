// The motions that the page shows, one or several side by side: in the same part of space, by the same scales.

const page = JSON.parse(document.getElementById("data").textContent);
const several = page.motions.length > 1;

/** `element` and copies after it, `count` in all; their ids end in their numbers. */
function copies(element, count) {
  const all = [element];
  while (all.length < count) {
    const copy = element.cloneNode(true);
    for (const named of copy.querySelectorAll("[id]")) named.id += `-${all.length + 1}`;
    all[all.length - 1].after(copy);
    all.push(copy);
  }
  return all;
}

// of those in the plane the view is given
for (const motion of page.motions) motion.view ??= around(motion);
for (const axes of [2, 3]) {
  const alike = page.motions.filter(({ view }) => view[0].length === axes);
  const shown = alike.length > 0 && united(alike.map(({ view }) => view));
  for (const motion of alike) motion.view = shown;
}

const figures = copies(document.querySelector("figure"), page.motions.length);
const computations = copies(document.querySelector(".computation"), page.motions.length);
const pictures = page.motions.map((motion, k) =>
  pictureOf(motion, figures[k], () => Math.min(...pictures.map(({ fitting }) => fitting()))));

/** The quantities of all motions, each once; every motion has its own in these places, or none. */
const quantities = pictures.flatMap((picture) => picture.quantities)
  .filter(({ name }, k, all) => k === all.findIndex((quantity) => quantity.name === name));
for (const { quantities: own } of pictures) {
  own.splice(0, own.length, ...quantities.map(({ name }) => own.find((quantity) => quantity.name === name)));
}

// the same colours for the same values
quantities.forEach((_, k) => {
  const same = pictures.map(({ quantities: own }) => own[k]).filter((quantity) => quantity);
  const largest = (key) => Math.max(...same.map((quantity) => quantity[key]));
  const [scale, peak] = [largest("scale"), largest("peak")];
  for (const quantity of same) Object.assign(quantity, { scale, peak });
});

const first = Math.min(...pictures.map((picture) => picture.first));
const last = Math.max(...pictures.map((picture) => picture.last));
/** Times of all samples, those that differ by no more than round-off once. */
const times = pictures.flatMap((picture) => picture.times).sort((a, b) => a - b)
  .filter((time, k, all) => k === 0 || time - all[k - 1] > 1e-9 * (last - first));
/** Phases of all motions, where they have the same ones. */
const phases = pictures.every((picture) =>
  JSON.stringify(picture.phases.map(({ name, end }) => [name, end])) ===
  JSON.stringify(pictures[0].phases.map(({ name, end }) => [name, end]))) ? pictures[0].phases : [];

const names = pictures.map(({ name }) => name);
const isThere = ({ values }) => values.some((value) => value !== 0);
/** The energies that some of the motions have. */
const present = pictures.flatMap(({ energies }) => energies.filter(isThere)).map(({ name }) => name);
const charts = [
  chartOfEnergies(pictures.map(({ energies }) => energies.filter(({ name }) => present.includes(name)))),
  ...chartsOfSensors(pictures.map(({ sensors }) => sensors)),
];
