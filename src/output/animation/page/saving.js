// The frame that is shown, as a file.

/** Offers `blob` as a file that is named after the time shown. */
function offerFile(blob, ending) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `frame-${now.toFixed(decimals)}s.${ending}`;
  link.click();
  // not before the browser has taken it
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function savePixels() {
  const copy = document.createElement("canvas");
  [copy.width, copy.height] = [stage.width, stage.height];
  const context = copy.getContext("2d");
  context.fillStyle = paint("card");
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(stage, 0, 0);
  copy.toBlob((blob) => offerFile(blob, "png"));
}

function saveVectors() {
  const file = vectorsOf(stage, (drawing) => drawFrame(drawing, momentAt(now)));
  offerFile(new Blob([file], { type: "image/svg+xml" }), "svg");
}
