// Numbers, units and steps for the eye.

const PREFIXES = [
  [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"],
];
const LENGTHS = [[1, "m"], [1e-2, "cm"], [1e-3, "mm"], [1e-6, "µm"]];

/** The factor and the unit with which numbers up to `largest` read well. */
function prefixed(largest, unit) {
  const found = PREFIXES.find(([factor]) => largest >= 0.9999 * factor);
  const [factor, prefix] = found ?? (largest > 0 ? PREFIXES[PREFIXES.length - 1] : [1, ""]);
  return { factor, unit: prefix + unit };
}

/** Units that take a prefix. */
const PREFIXED = ["m", "s", "m/s", "N", "J", "Pa", "rad"];

/** The same for any unit: others take a power of ten where numbers are very large or small. */
function scaled(largest, unit) {
  if (PREFIXED.includes(unit)) return prefixed(largest, unit);
  const name = unit === "1" ? "" : unit.replace("^2", "\u00b2").replace("^3", "\u00b3");
  if (largest >= 1e-3 && largest < 1e4) return { factor: 1, unit: name };
  const power = 3 * Math.floor(Math.log10(largest) / 3);
  const raised = String(power).replace(/./g, (sign) => (sign === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[sign]));
  return { factor: Number(`1e${power}`), unit: `10${raised} ${name}`.trim() };
}

/** The same for lengths (m) that are part of a picture as large as `extent`. */
function lengthUnit(extent) {
  const [factor, unit] =
    LENGTHS.find(([factor]) => extent >= 2 * factor) ?? LENGTHS[LENGTHS.length - 1];
  return { factor, unit };
}

/** A number with `digits` significant digits, without zeros that say nothing. */
function number(value, digits = 3) {
  return signed(String(Number(value.toPrecision(digits))));
}

function fixed(value, decimals) {
  const text = value.toFixed(decimals);
  return signed(Number(text) === 0 ? text.replace("-", "") : text);
}

function signed(text) {
  return text.replace("-", "\u2212");
}

/** Round numbers from `low` to `high`, about `count` of them, and the decimals they need. */
function ticks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 2.5, 5, 10].find((factor) => factor * power >= 0.999 * rough);
  let decimals = 0;
  while (decimals < 12 && Math.abs(step - Number(step.toFixed(decimals))) > 1e-6 * step) decimals++;
  const values = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    values.push(k * step);
  }
  return { values, decimals, step };
}
