"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const plot = document.getElementById("plot");
  const shown = document.getElementById("shown");
  let chosen = -1;

  const element = (name, text, of) => {
    const made = document.createElement(name);
    if (text !== undefined) made.textContent = text;
    if (of) of.append(made);
    return made;
  };

  const line = (table, name, value) => {
    const row = element("tr", undefined, table);
    element("th", name, row);
    element("td", value, row);
  };

  const number = (value, unit) =>
    value === null ? "none" : `${Number(value.toPrecision(6))}${unit ? " " + unit : ""}`;

  const choose = (at) => {
    const row = data.rows[at];
    if (!row) return;
    chosen = at;
    for (const mark of plot.querySelectorAll(".chosen")) mark.classList.remove("chosen");
    for (const mark of plot.querySelectorAll(`[data-row="${at}"]`)) {
      mark.classList.add("chosen");
      mark.parentNode.append(mark); // over the others
    }
    shown.replaceChildren();
    element("h2", `Run ${row.id}`, shown);
    const table = element("table", undefined, shown);
    data.keys.forEach((key, k) => line(table, key, row.keys[k]));
    data.quantities.forEach((name, k) => line(table, name, number(row.quantities[k], data.units[k])));
    line(table, "verdict", row.verdict);
    if (row.warnings.length) line(table, "warnings", row.warnings.join(", "));
    if (row.failure) line(table, "failure", row.failure);
    line(table, "time", `${row.seconds.toPrecision(3)} s`);
    if (row.animation) {
      const frame = element("iframe", undefined, shown);
      frame.title = "The motion of this run";
      frame.src = row.animation;
    } else {
      const how = element("p", "Its motion was not kept: --keep keeps those that fulfil a condition.", shown);
      how.className = "how";
    }
  };

  plot.addEventListener("click", (event) => {
    const mark = event.target.closest("[data-row]");
    if (mark) choose(Number(mark.dataset.row));
  });
  document.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    choose((chosen + step + data.rows.length) % data.rows.length);
  });
})();
