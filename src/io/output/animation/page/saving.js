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

/** Height of the line with the names above several pictures (px). */
const NAMES = several ? 24 : 0;

/** The size of all pictures side by side (px). */
function sizeOfFrame() {
  const stages = pictures.map(({ stage }) => stage);
  const width = stages.reduce((sum, stage) => sum + stage.clientWidth, 0);
  return [width, stages[0].clientHeight + NAMES];
}

/** Draws each picture in its place, by `draw`. */
function drawBeside(context, draw) {
  let left = 0;
  for (const picture of pictures) {
    context.save();
    context.translate(left, 0);
    if (several) {
      context.fillStyle = paint("ink");
      context.textAlign = "left";
      context.textBaseline = "middle";
      context.fillText(picture.name, 8, NAMES / 2);
    }
    context.translate(0, NAMES);
    draw(picture);
    context.restore();
    left += picture.stage.clientWidth;
  }
}

function savePixels() {
  const copy = document.createElement("canvas");
  const fine = window.devicePixelRatio || 1;
  const [width, height] = sizeOfFrame();
  [copy.width, copy.height] = [Math.round(width * fine), Math.round(height * fine)];
  const context = copy.getContext("2d");
  context.scale(fine, fine);
  context.font = FONT;
  context.fillStyle = paint("card");
  context.fillRect(0, 0, width, height);
  drawBeside(context, ({ stage }) => context.drawImage(stage, 0, 0, stage.clientWidth, stage.clientHeight));
  copy.toBlob((blob) => offerFile(blob, "png"));
}

function saveVectors() {
  const file = vectorsOf(sizeOfFrame(), ({ context, hatching }) => drawBeside(context, (picture) => {
    const { clientWidth: width, clientHeight: height } = picture.stage;
    drawFrame(picture, { context, width, height, hatching });
  }));
  offerFile(new Blob([file], { type: "image/svg+xml" }), "svg");
}
