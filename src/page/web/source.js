// The source of all data of the page: here, the server of `jabuka preview`. The playground and a page in one file have others with the same exports.
//
// Every request must contain the token from the address of the page, except those for the page's own files.

const token = new URLSearchParams(location.search).get("token");

/** What the page says if the source cannot give any data. */
export const REFUSED = token ? null : "Open the whole address that `jabuka preview` has printed.";

/** What the page says if the source does not answer any more. */
export const LOST = "The server does not answer: `jabuka preview` has ended, or the connection is lost.";

/** True if the source renders frames with POV-Ray. */
export const CAN_RENDER = true;

/** True if the source computes what a page asks for: other methods, scripts, models. */
export const CAN_COMPUTE = true;

function address(path, parameters = {}) {
  return `${path}?${new URLSearchParams({ ...parameters, token })}`;
}

async function answer(response) {
  if (response.ok) return response;
  const error = new Error((await response.text()).trim());
  error.status = response.status;
  throw error;
}

export async function json(path, parameters) {
  return (await answer(await fetch(address(path, parameters)))).json();
}

export async function binary(path, parameters, signal) {
  return (await answer(await fetch(address(path, parameters), { signal }))).arrayBuffer();
}

async function post(path, order) {
  const headers = { "Content-Type": "application/json" };
  return answer(await fetch(address(path), { method: "POST", headers, body: JSON.stringify(order) }));
}

/** Starts a run with another integration method, and returns its progress. */
export async function startVariant(variant) {
  return (await post("/api/variants", variant)).json();
}

/** How the page edits the text of the scene: when the user opens it; the time without a further key after which it is written, ms. */
export const TEXT = { isOpen: false, pause: 300 };

/** Returns the file of the scene, its text and the version of the text. */
export const readText = () => json("/api/text");

/** Writes the text into the file, and returns its version. Fails with status 409 if the file does not have the version `base`. */
export async function writeText(text, base) {
  return (await post("/api/save", { text, base })).json();
}

/** Gives a variable that has a slider another value. */
export async function setVariable(variable, value) {
  await post("/api/variables", { variable, value });
}

/** What the page says below sliders that were moved. */
export const MOVED = "The file keeps its values: write into it what you like.";

/** Renders a frame with POV-Ray, and returns the image. */
export async function renderFrame(wanted) {
  return (await post("/api/render", wanted)).blob();
}

/**
 * Calls `changed` with the state of the server, now and after each change. Calls `lost` when the server has stopped. A hidden page
 * does not listen, since browsers limit the number of connections to one server.
 */
export function follow(changed, lost) {
  let events;
  const listen = () => {
    events?.close();
    events = document.hidden ? undefined : new EventSource(address("/api/events"));
    if (!events) return;
    events.onmessage = (event) => changed(JSON.parse(event.data));
    events.onerror = lost;
  };
  document.addEventListener("visibilitychange", listen);
  listen();
}
