// What colours mean: the choice of quantities, and the scale.

/** Number of the chosen quantity; beyond the last: one colour. */
let chosen = 0;

/** A value in 255ths of the scale that goes to `own`, in 255ths of the one that goes to `scale`; both are 0 at the same place. */
function rescaled(value, own, scale, signed) {
  const zero = signed ? 127.5 : 0;
  return scale > 0 ? zero + ((value - zero) * own) / scale : zero;
}

/** The choice of quantities; `redraw` is called after a choice. */
function offerQuantities(quantities, redraw) {
  const choice = document.getElementById("quantity");
  for (const { name } of [...quantities, { name: "None" }]) choice.append(new Option(name));
  const choose = () => {
    chosen = choice.selectedIndex;
    showScale(quantities[chosen]);
    redraw();
  };
  choice.addEventListener("change", choose);
  document.getElementById("ramp").style.background =
    `linear-gradient(to right, ${VIRIDIS.map((colour) => rgb(colour)).join()})`;
  showScale(quantities[chosen]);
}

function showScale(quantity) {
  document.getElementById("scale").hidden = !quantity;
  const peak = document.getElementById("peak");
  const ends = document.getElementById("ends");
  peak.textContent = "";
  if (!quantity) return;
  const { factor, unit } = (quantity.unit === "1" ? scaled : prefixed)(quantity.scale, quantity.unit);
  const most = quantity.scale / factor;
  const beyond = quantity.peak > 1.001 * quantity.scale;
  const end = `${beyond ? "\u2265 " : ""}${number(most)} ${unit}`.trim();
  const labels = quantity.signed ? [number(-most), "0", end] : ["0", number(most / 2), end];
  ends.replaceChildren(...(most > 0 ? labels : ["0 everywhere"]).map((label) => {
    const mark = document.createElement("span");
    mark.textContent = label;
    return mark;
  }));
  if (beyond) {
    peak.textContent = `99 % of all cells and times are ${quantity.signed ? "within" : "below"}; largest ${number(quantity.peak / factor)} ${unit}`.trim();
  }
}
