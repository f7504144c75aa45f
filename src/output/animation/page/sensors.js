// What sensors have read: a chart for each unit, as that of the energies.

/** Colours of the style sheet: those of the energies tell sensors apart as well. */
const COLOURS = ["kinetic", "strain", "gravity", "contact", "springs", "dissipated", "supplied", "balance"];
/** For those beyond the colours. */
const STROKES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];

const sensorCharts = [...new Set(sensors.map(({ unit }) => unit))].map((unit) => {
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
  plot.setAttribute("aria-label", `Sensors (${named}) over time. The time slider moves the line.`);
  list.setAttribute("role", "group");
  list.setAttribute("aria-label", `Sensors shown (${named})`);
  frame.append(plot, cursor);
  document.getElementById("sensors").append(frame, list);
  const read = sensors.filter((sensor) => sensor.unit === unit);
  const series = read.map((sensor, k) => ({
    ...sensor,
    colour: COLOURS[k % COLOURS.length],
    dashes: STROKES[Math.floor(k / COLOURS.length) % STROKES.length],
  }));
  return new Chart(elements, series, unit, false);
});
document.getElementById("sensors").hidden = sensors.length === 0;
