// What the editor knows of the keys of scenes: it completes and explains them by jabuka's schema.

import { json } from "../source.js";

let schema;

/** Fetches the schema when it is first needed. A worker that ends meanwhile is asked again the next time. */
async function known() {
  schema ??= json("/api/schema").catch(() => (schema = undefined));
  return schema;
}

/** Returns the schemas that a value may follow, as a list. */
function choices(node) {
  if (!node || typeof node !== "object") return [];
  return [node, ...(node.anyOf ?? []).flatMap(choices), ...(node.oneOf ?? []).flatMap(choices)];
}

/** Returns the schemas of the value at a path of keys. */
function at(root, path) {
  return path.reduce((nodes, key) => {
    const inner = nodes.flatMap((node) => [node.properties?.[key] ?? node.additionalProperties]);
    return inner.flatMap(choices);
  }, choices(root));
}

const parts = (path) => path.split(".").map((key) => key.trim().replace(/^["']|["']$/g, "")).filter(Boolean);

/** Returns the keys of the table that a line belongs to. */
function table(document, line) {
  for (let number = line; number > 0; number--) {
    const header = /^\s*\[\[?\s*([^\]]+?)\s*\]/.exec(document.line(number).text);
    if (header) return parts(header[1]);
  }
  return [];
}

function option(name, node) {
  return { label: name, type: "property", info: node?.description ?? choices(node).find(({ description }) => description)?.description };
}

function properties(nodes) {
  return nodes.flatMap((node) => Object.entries(node.properties ?? {})).map(([name, node]) => option(name, node));
}

/** Completes the key or the value before the cursor. */
export async function completions(context) {
  const line = context.state.doc.lineAt(context.pos);
  const before = line.text.slice(0, context.pos - line.from);
  const root = await known();
  if (!root) return null;
  const header = /^\s*\[\[?([\w.-]*)$/.exec(before);
  if (header) {
    const path = header[1].split(".");
    return { from: context.pos - path.at(-1).length, options: properties(at(root, path.slice(0, -1))), validFor: /^[\w-]*$/ };
  }
  const of = table(context.state.doc, line.number);
  const value = /^\s*([\w.-]+)\s*=\s*("?)([\w-]*)$/.exec(before);
  if (value) {
    const nodes = at(root, [...of, ...parts(value[1])]);
    const words = new Set(nodes.flatMap(({ enum: values, type }) => values ?? (type === "boolean" ? [true, false] : [])));
    const written = [...words].map((word) => (value[2] || typeof word !== "string" ? `${word}` : `"${word}"`));
    if (!written.length) return null;
    return { from: context.pos - value[3].length, options: written.map((label) => ({ label, type: "enum" })), validFor: /^[\w-]*$/ };
  }
  const key = /^\s*([\w.-]*)$/.exec(before);
  if (!key || (!key[1] && !context.explicit)) return null;
  const path = key[1].split(".");
  return { from: context.pos - path.at(-1).length, options: properties(at(root, [...of, ...path.slice(0, -1)])), validFor: /^[\w-]*$/ };
}

/** Explains the key under the pointer. */
export async function described(view, position) {
  const { doc } = view.state;
  const line = doc.lineAt(position);
  const key = /^\s*([\w.-]+)\s*=/.exec(line.text);
  const column = position - line.from;
  if (!key || column > key[0].length) return null;
  const root = await known();
  if (!root) return null;
  const start = key[0].indexOf(key[1]);
  // The name under the pointer is a part of the path.
  const end = line.text.slice(column).search(/[^\w-]|$/) + column;
  const path = [...table(doc, line.number), ...parts(line.text.slice(start, end))];
  const text = at(root, path).find(({ description }) => description)?.description;
  if (!text) return null;
  const create = () => {
    const dom = document.createElement("div");
    dom.className = "described";
    dom.textContent = `${path.at(-1)}: ${text}`;
    return { dom };
  };
  return { pos: line.from + start, end: line.from + end, above: true, create };
}
