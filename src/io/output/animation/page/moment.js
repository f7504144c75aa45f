// Numbers between samples.

/** The samples before and after a time among `times`, and how far it is from one to the other; at the ends it stays. */
function momentIn(times, wanted) {
  const time = Math.min(Math.max(wanted, times[0]), times[times.length - 1]);
  let before = 0;
  let after = times.length - 1;
  while (after - before > 1) {
    const middle = (before + after) >> 1;
    if (times[middle] <= time) before = middle;
    else after = middle;
  }
  const span = times[after] - times[before];
  const share = span > 0 ? Math.min(Math.max((time - times[before]) / span, 0), 1) : 0;
  return { time, before, after, share };
}

function between(values, from, to, share) {
  return values[from] + (values[to] - values[from]) * share;
}

/** A number over time; at a sample its own, whatever is beside it. */
function seriesAt({ before, after, share }, { values }) {
  if (share === 0 || share === 1) return values[share === 0 ? before : after];
  return between(values, before, after, share);
}
