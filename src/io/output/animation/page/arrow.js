// One arrow.

/** From a point along a vector (px), in `colour`; `around` it may have an edge in another one. */
function drawArrow(context, [x, y], [dx, dy], colour, thick = 2.5, around = null) {
  const length = Math.hypot(dx, dy);
  if (length < 1) return;
  const head = Math.min(3.6 * thick, 0.6 * length);
  const [tx, ty] = [dx / length, dy / length];
  const line = (width) => {
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx - head * tx, y + dy - head * ty);
    context.stroke();
  };
  const traceTip = () => {
    context.beginPath();
    context.moveTo(x + dx, y + dy);
    context.lineTo(x + dx - head * tx - 0.45 * head * ty, y + dy - head * ty + 0.45 * head * tx);
    context.lineTo(x + dx - head * tx + 0.45 * head * ty, y + dy - head * ty - 0.45 * head * tx);
    context.closePath();
  };
  if (around) {
    context.strokeStyle = paint(around);
    line(2 * thick);
    context.lineWidth = thick;
    traceTip();
    context.stroke();
  }
  context.strokeStyle = context.fillStyle = paint(colour);
  line(thick);
  traceTip();
  context.fill();
}
