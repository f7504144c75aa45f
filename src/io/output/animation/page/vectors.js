// A sheet that keeps what is drawn on it as SVG.

const STATE = ["fillStyle", "strokeStyle", "lineWidth", "lineCap", "lineJoin", "globalAlpha", "textAlign", "textBaseline"];
const ANCHORS = { left: "start", center: "middle", right: "end" };
/** Where the baseline is, in heights of letters below the point. */
const DROPS = { top: 0.8, middle: 0.35, bottom: -0.2 };

/** As much of a canvas's context as drawing the stage asks for. Transforms and clips are groups, to the next `restore`. */
class Vectors {
  fillStyle = "#000";
  strokeStyle = "#000";
  lineWidth = 1;
  lineCap = "butt";
  lineJoin = "round";
  globalAlpha = 1;
  textAlign = "left";
  textBaseline = "middle";
  /** Elements by name and attributes, and ends of groups as text. */
  parts = [];
  path = "";
  saved = [];
  groups = 0;
  clips = 0;

  save() {
    this.saved.push(Object.fromEntries([...STATE, "groups"].map((name) => [name, this[name]])));
    this.groups = 0;
  }

  restore() {
    this.parts.push("</g>".repeat(this.groups));
    Object.assign(this, this.saved.pop());
  }

  group(attributes) {
    this.parts.push(`<g ${attributes}>`);
    this.groups++;
  }

  translate(x, y) {
    this.group(`transform="translate(${brief(x)} ${brief(y)})"`);
  }

  rotate(angle) {
    this.group(`transform="rotate(${(angle * 180) / Math.PI})"`);
  }

  clip() {
    this.clips++;
    this.parts.push(`<clipPath id="clip${this.clips}"><path d="${this.path}"/></clipPath>`);
    this.group(`clip-path="url(#clip${this.clips})"`);
  }

  beginPath() {
    this.path = "";
  }

  moveTo(x, y) {
    this.path += `M${brief(x)} ${brief(y)}`;
  }

  lineTo(x, y) {
    this.path += `${this.path ? "L" : "M"}${brief(x)} ${brief(y)}`;
  }

  quadraticCurveTo(cx, cy, x, y) {
    this.path += `Q${[cx, cy, x, y].map(brief).join(" ")}`;
  }

  rect(x, y, width, height) {
    this.path += `M${brief(x)} ${brief(y)}h${brief(width)}v${brief(height)}h${brief(-width)}z`;
  }

  /** In two halves, neither of which is a full circle. */
  arc(x, y, radius, from, to) {
    const turn = 2 * Math.PI;
    const sweep = to - from >= turn ? turn : (((to - from) % turn) + turn) % turn;
    const at = (angle) => [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
    this.lineTo(...at(from));
    for (const share of [0.5, 1]) {
      this.path += `A${[radius, radius, 0, 0, 1, ...at(from + share * sweep)].map(brief).join(" ")}`;
    }
  }

  closePath() {
    this.path += "z";
  }

  fill(rule = "nonzero") {
    const attributes = { d: this.path, fill: this.fillStyle, "fill-opacity": this.globalAlpha, "fill-rule": rule };
    this.parts.push({ name: "path", attributes });
  }

  /** A path that was filled just before gets its stroke there. */
  stroke() {
    let { attributes } = this.parts.at(-1) ?? {};
    if (attributes?.d !== this.path || attributes.stroke) {
      attributes = { d: this.path, fill: "none" };
      this.parts.push({ name: "path", attributes });
    }
    Object.assign(attributes, {
      stroke: this.strokeStyle,
      "stroke-width": this.lineWidth,
      "stroke-opacity": this.globalAlpha,
      "stroke-linecap": this.lineCap,
      "stroke-linejoin": this.lineJoin,
    });
  }

  fillText(text, x, y) {
    const attributes = {
      x,
      y,
      dy: `${DROPS[this.textBaseline]}em`,
      "text-anchor": ANCHORS[this.textAlign],
      fill: this.fillStyle,
    };
    this.parts.push({ name: "text", attributes, text });
  }

  /** The picture of `width` times `height` pixels as the text of a file. */
  file(width, height) {
    const hatching =
      `<pattern id="hatch" width="8" height="8" patternUnits="userSpaceOnUse">` +
      `<path d="M0 0h8v8h-8z" fill="${paint("solid")}"/>` +
      `<path d="M-8 8L0 0M0 8L8 0M8 8L16 0" stroke="${paint("hatch")}"/></pattern>`;
    const parts = this.parts.map((part) => {
      if (typeof part === "string") return part;
      const { name, attributes, text = "" } = part;
      const listed = Object.entries(attributes).map(([key, value]) => ` ${key}="${plain(String(value))}"`);
      return `<${name}${listed.join("")}>${plain(text)}</${name}>`;
    });
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" ` +
      `font-family="system-ui, Helvetica, Arial, sans-serif" font-size="12"><defs>${hatching}</defs>` +
      `<rect width="${width}" height="${height}" fill="${paint("card")}"/>${parts.join("\n")}</svg>\n`
    );
  }
}

function brief(number) {
  return Number(number.toFixed(2));
}

function plain(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");
}

/** What `draw` draws on a sheet of that size (px), as an SVG file. */
function vectorsOf([width, height], draw) {
  const context = new Vectors();
  draw({ context, hatching: () => "url(#hatch)" });
  return context.file(width, height);
}
