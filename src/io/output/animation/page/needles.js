// Needles of devices: bars of one size, with a north pole and a south pole.

/** Half the length of a bar (px). */
const POLE = 12;

function drawNeedles(context, place, direct, moment) {
  const needles = needlesAt(moment);
  for (let start = 0; start < needles.length; start += 2 * axes) {
    const at = needles.slice(start, start + axes);
    const along = Array.from(needles.slice(start + axes, start + 2 * axes));
    const size = Math.hypot(...along);
    const [x, y] = place(at);
    context.lineWidth = 7;
    context.lineCap = "butt";
    // one without direction is a dot alone
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
