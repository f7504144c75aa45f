// What sensors have read: a chart for each unit, as that of the energies.

/** Colours of the style sheet: those of the energies tell sensors apart as well. */
const COLOURS = ["kinetic", "strain", "gravity", "contact", "springs", "dissipated", "supplied", "balance"];
/** The charts of the sensors of each motion. */
function chartsOfSensors(motions) {
  const units = [...new Set(motions.flat().map(({ unit }) => unit))];
  document.getElementById("sensors").hidden = units.length === 0;
  return units.map((unit) => chartOfSensors(motions.map((sensors) => sensors.filter((sensor) => sensor.unit === unit)), unit));
}

function chartOfSensors(motions, unit) {
  const element = (tag, className) => Object.assign(document.createElement(tag), { className });
  const elements = {
    frame: element("div", "chart"),
    plot: element("canvas", ""),
    cursor: element("div", "cursor"),
    list: element("div", "series"),
  };
  const { frame, plot, cursor, list } = elements;
  const named = unit === "1" ? "numbers" : unit;
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", `Sensors (${named}) over time`);
  list.setAttribute("role", "group");
  list.setAttribute("aria-label", `Sensors shown (${named})`);
  frame.append(plot, cursor);
  document.getElementById("sensors").append(frame, list);
  const colourOf = (_, k) => COLOURS[k % COLOURS.length];
  const dashesOf = (_, k) => STROKES[Math.floor(k / COLOURS.length) % STROKES.length];
  return new Chart(elements, seriesOf(motions, colourOf, dashesOf), unit, false);
}
