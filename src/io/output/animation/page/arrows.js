// Arrows that stand for forces.

const arrows = document.getElementById("arrows");
/** Length of the longest arrow at most (px). */
const LONGEST = 80;

/** The force that is as long as the longest arrow, if the largest one is `strongest` (N): a round number. */
function roundForce(strongest) {
  const power = 10 ** Math.floor(Math.log10(strongest || 1));
  return [1, 2, 5, 10].map((digit) => digit * power).find((force) => force >= 0.999 * strongest);
}

/** The box to tick, if there are forces, and how long arrows are; `redraw` is called after a tick. */
function offerArrows(exist, forceOfLongest, redraw) {
  document.getElementById("contacts").hidden = !exist;
  const legend = document.getElementById("newtons");
  const { factor, unit } = prefixed(forceOfLongest, "N");
  legend.append(`= ${number(forceOfLongest / factor)} ${unit}`);
  arrows.addEventListener("change", () => {
    legend.hidden = !arrows.checked;
    redraw();
  });
}
