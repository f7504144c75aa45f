// Arrows that stand for forces.

const arrows = document.getElementById("arrows");
/** Length of the longest arrow at most (px). */
const LONGEST = 80;

/** The force that is as long as the longest arrow, if the largest one is `strongest` (N): a round number. */
function roundForce(strongest) {
  const power = 10 ** Math.floor(Math.log10(strongest || 1));
  return [1, 2, 5, 10].map((digit) => digit * power).find((force) => force >= 0.999 * strongest);
}

function drawArrow(context, [x, y], [dx, dy]) {
  const length = Math.hypot(dx, dy);
  if (length < 1) return;
  const head = Math.min(9, 0.6 * length);
  const [tx, ty] = [dx / length, dy / length];
  context.strokeStyle = context.fillStyle = paint("contact");
  context.lineWidth = 2.5;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + dx - head * tx, y + dy - head * ty);
  context.stroke();
  context.beginPath();
  context.moveTo(x + dx, y + dy);
  context.lineTo(x + dx - head * tx - 0.45 * head * ty, y + dy - head * ty + 0.45 * head * tx);
  context.lineTo(x + dx - head * tx + 0.45 * head * ty, y + dy - head * ty - 0.45 * head * tx);
  context.closePath();
  context.fill();
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
