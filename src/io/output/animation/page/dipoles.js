// Dipoles: bars along their moments, with a north pole and a south pole.

/** Half the length of a bar (px). */
const POLE = 12;

function drawDipoles(context, place, direct, moment) {
  for (const dipole of dipoles) {
    const [at, along] = dipoleAt(moment, dipole);
    const size = Math.hypot(...along);
    const [x, y] = place(at);
    context.lineWidth = 7;
    context.lineCap = "butt";
    // one that is off is a dot alone
    for (const [end, colour] of size > 0 ? [[POLE, "push"], [-POLE, "pull"]] : []) {
      const [dx, dy] = direct(along).map((part) => (end * part) / size);
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + dx, y + dy);
      context.strokeStyle = paint(colour);
      context.stroke();
    }
    context.beginPath();
    context.arc(x, y, 2.5, 0, 7);
    context.fillStyle = paint("ink");
    context.fill();
  }
}
