// Lines beside the bodies: where surfaces of liquids meet the walls, and devices.

function drawLines(context, place, moment) {
  const ends = linesAt(moment);
  context.beginPath();
  for (let end = 0; end < ends.length; end += axes) {
    const [x, y] = place(ends.slice(end, end + axes));
    if ((end / axes) % 2 === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
  context.lineWidth = 2;
  context.strokeStyle = paint("pull");
  context.stroke();
}
