// Paints the plots and the texts over a picture to a canvas, as texts.js and scene_plots.js show them on the page.

import { USUAL_FAMILY } from "./texts.js";

/** Loads the fonts that a canvas needs. Unlike the page, a canvas does not wait for them. */
export async function loadFonts() {
  await Promise.all(["", "bold "].map((weight) => document.fonts.load(`${weight}16px ${USUAL_FAMILY}`)));
}

/** Paints what `layout` of texts.js returns. */
export function paintOverlay(context, { plots, texts }) {
  for (const { shapes } of plots) for (const [kind, attributes] of shapes) SHAPES[kind](context, attributes);
  for (const text of texts) {
    if (text.bar) paintBar(context, text);
    else paintText(context, text);
  }
}

/** How a shape of each kind is painted. */
const SHAPES = {
  rect(context, { x, y, width, height, fill, colors, "fill-opacity": opacity = 1 }) {
    context.globalAlpha = opacity;
    context.fillStyle = colors ? gradient(context, colors, x, x + width) : fill;
    context.fillRect(x, y, width, height);
    context.globalAlpha = 1;
  },
  line: (context, { x1, y1, x2, y2, ...look }) => stroke(context, [[x1, y1], [x2, y2]], look),
  polyline: (context, { points, ...look }) => stroke(context, points, look),
  circle(context, { cx, cy, r, fill }) {
    context.fillStyle = fill;
    context.beginPath();
    context.arc(cx, cy, r, 0, 2 * Math.PI);
    context.fill();
  },
};

function gradient(context, colors, left, right) {
  const made = context.createLinearGradient(left, 0, right, 0);
  colors.forEach((color, k) => made.addColorStop(k / (colors.length - 1), color));
  return made;
}

function stroke(context, points, { stroke: color, "stroke-width": width, "stroke-linejoin": join = "miter", "stroke-linecap": cap = "butt" }) {
  Object.assign(context, { strokeStyle: color, lineWidth: width, lineJoin: join, lineCap: cap });
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

function paintBar(context, { bar, color }) {
  context.fillStyle = color;
  context.fillRect(...bar);
}

function paintText(context, { says, x, y, size, line, align, color, halo, family = USUAL_FAMILY, axis }) {
  const fontOf = (part, bold) => (axis ? `600 ${part * size}px system-ui, sans-serif` : `${bold ? "bold " : ""}${part * size}px ${family}`);
  context.font = fontOf(1, false);
  const { fontBoundingBoxAscent: above, fontBoundingBoxDescent: below } = context.measureText("");
  // The letters stand where the page's style sheet has them: in the middle of a line, which begins 0.35 letters and half a line above `y`.
  const first = y - 0.35 * size + (above - below) / 2;
  linesOf(says).forEach((parts, row) => {
    const set = parts.map(([letters, part, rise, bold]) => {
      context.font = fontOf(part, bold);
      return { letters, font: context.font, rise: rise * size, width: context.measureText(letters).width };
    });
    let at = x - align * set.reduce((sum, { width }) => sum + width, 0);
    const places = set.map((part) => ({ ...part, left: (at += part.width) - part.width, base: first + row * line * size - part.rise }));
    if (halo) {
      Object.assign(context, { strokeStyle: halo, lineWidth: 2.5, lineJoin: "round" });
      for (const { letters, font, left, base } of places) {
        context.font = font;
        context.strokeText(letters, left, base);
      }
    }
    context.fillStyle = color;
    for (const { letters, font, left, base } of places) {
      context.font = font;
      context.fillText(letters, left, base);
    }
  });
}

/** Divides the parts of a text into lines. */
function linesOf(says) {
  const lines = [[]];
  for (const [letters, ...look] of says) {
    letters.split("\n").forEach((piece, i) => {
      if (i) lines.push([]);
      if (piece) lines.at(-1).push([piece, ...look]);
    });
  }
  return lines;
}
