// Links that hold a scene: its name and its text, compressed, behind the `#` of the address. Browsers do not send this part to any server.

/** The largest text that a link may hold, bytes. A link comes from anybody. */
const MAX_BYTES = 1 << 20;

async function through(stream, bytes, limit = Infinity) {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  const parts = [];
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.length;
    if (size > limit) {
      await reader.cancel();
      throw new Error("the scene in this link is too large");
    }
    parts.push(value);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** Returns the address of this page with a scene. */
export async function linkOf({ name, text }) {
  const bytes = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(JSON.stringify([name, text])));
  const letters = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  const { origin, pathname, protocol } = location;
  const page = protocol === "file:" ? `file://${pathname}` : origin + pathname;
  return `${page}#scene=${letters.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/** Returns the scene in the address: its `name` and `text`, the name of a scene of the gallery (`gallery`), or the tutorial. Undefined if there is none. */
export async function linked() {
  if (location.hash === "#tutorial") return { tutorial: true };
  const [, kind, value] = /^#(scene|gallery)=([\w-]+)$/.exec(location.hash) ?? [];
  if (!kind) return undefined;
  if (kind === "gallery") return { gallery: value };
  try {
    const letters = atob(value.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = await through(new DecompressionStream("deflate-raw"), Uint8Array.from(letters, (letter) => letter.charCodeAt(0)), MAX_BYTES);
    const [name, text] = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    if (typeof name !== "string" || typeof text !== "string" || !/^[\w-]{1,80}$/.test(name)) throw new Error("it holds no scene");
    return { name, text };
  } catch (error) {
    throw new Error(`This link is damaged: ${error.message}.`);
  }
}
