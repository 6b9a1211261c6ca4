// Draws the marks of a plot, on a canvas or as SVG. A mark is a line, a text, a dot or a box; its color is the name of one of the page.

/** The height from the baseline of a text to its middle, in sizes of its letters. */
const MIDDLE = 0.35;
/** How much of a faint line is to be seen. */
const FAINT = 0.55;
const FONT = "system-ui, sans-serif";

export const fontOf = (size) => `${size}px ${FONT}`;

/** Returns a function from the name of a color to the color that it has at an element. */
export function inkOf(element) {
  const style = getComputedStyle(element);
  const known = new Map();
  return (name) => {
    if (!known.has(name)) known.set(name, style.getPropertyValue(name).trim());
    return known.get(name);
  };
}

/** Draws marks on a canvas. `ink` returns the color with a name. */
export function drawMarks(context, marks, { area, size }, ink) {
  context.font = fontOf(size);
  context.lineJoin = "round";
  for (const mark of marks) {
    context.save();
    if (mark.clip) {
      context.beginPath();
      context.rect(area.left, area.top - 1, area.width + 1, area.height + 2);
      context.clip();
    }
    canvas[mark.kind](context, mark, ink, size);
    context.restore();
  }
}

const canvas = {
  line(context, { points, ink: name, width, dash, faint }, ink) {
    context.strokeStyle = ink(name);
    context.lineWidth = width;
    context.globalAlpha = faint ? FAINT : 1;
    if (dash) context.setLineDash(dash);
    context.beginPath();
    for (let k = 0; k < points.length; k += 2) context.lineTo(points[k], points[k + 1]);
    context.stroke();
  },
  text(context, { text, x, y, align, ink: name }, ink, size) {
    context.fillStyle = ink(name);
    context.textAlign = align;
    context.fillText(text, x, y + MIDDLE * size);
  },
  dot(context, { x, y, r, ink: name, ring }, ink) {
    context.fillStyle = ink(name);
    context.beginPath();
    context.arc(x, y, r, 0, 2 * Math.PI);
    context.fill();
    if (!ring) return;
    context.strokeStyle = ink("--paper");
    context.lineWidth = 1.5;
    context.stroke();
  },
  box(context, { x, y, width, height }, ink) {
    context.fillStyle = ink("--paper");
    context.strokeStyle = ink("--line");
    context.lineWidth = 1;
    context.globalAlpha = 0.94;
    context.beginPath();
    context.roundRect(Math.round(x) + 0.5, Math.round(y) + 0.5, Math.round(width), Math.round(height), 4);
    context.fill();
    context.stroke();
  },
};

/** Returns a plot as an SVG file with a white background, and a margin. */
export function asSvg({ marks, area, width, height, size }, ink) {
  const drawn = marks.map((mark) => svg[mark.kind](mark, ink, size));
  const clip = tag("rect", { x: area.left, y: area.top - 1, width: area.width + 1, height: area.height + 2 });
  const paper = { x: -size, y: -size, width: width + 2 * size, height: height + 2 * size };
  const font = `font-family="${FONT}" font-size="${size}"`;
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${paper.width}" height="${paper.height}" viewBox="${Object.values(paper).join(" ")}" ${font}>`,
    `<defs><clipPath id="area">${clip}</clipPath></defs>`,
    tag("rect", { ...paper, fill: "#ffffff" }),
    ...drawn,
    "</svg>\n",
  ].join("\n");
}

const ANCHOR = { left: "start", center: "middle", right: "end" };

const svg = {
  line({ points, ink: name, width, dash, faint, clip }, ink) {
    const places = Array.from({ length: points.length / 2 }, (_, k) => `${rounded(points[2 * k])},${rounded(points[2 * k + 1])}`);
    return tag("polyline", {
      points: places.join(" "), fill: "none", stroke: ink(name), "stroke-width": rounded(width), "stroke-linejoin": "round",
      "stroke-dasharray": dash?.map(rounded).join(" "), "stroke-opacity": faint ? FAINT : undefined, "clip-path": clip && "url(#area)",
    });
  },
  text({ text, x, y, align, ink: name }, ink, size) {
    return tag("text", { x: rounded(x), y: rounded(y + MIDDLE * size), fill: ink(name), "text-anchor": ANCHOR[align] }, escaped(text));
  },
  dot({ x, y, r, ink: name }, ink) {
    return tag("circle", { cx: rounded(x), cy: rounded(y), r: rounded(r), fill: ink(name) });
  },
};

const rounded = (number) => Math.round(100 * number) / 100;

function tag(name, attributes, content) {
  const given = Object.entries(attributes).filter(([, value]) => value !== undefined && value !== false);
  const written = given.map(([key, value]) => ` ${key}="${escaped(String(value))}"`).join("");
  return content === undefined ? `<${name}${written}/>` : `<${name}${written}>${content}</${name}>`;
}

const ESCAPES = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&apos;" };
const escaped = (text) => text.replace(/[&<>"']/g, (letter) => ESCAPES[letter]);
