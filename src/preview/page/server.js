// Communicates with the server. Every request must contain the token from the address of the page, except those for the page's own files.

export const token = new URLSearchParams(location.search).get("token");

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

/** Sends a POST request, and returns the server's answer. */
export async function post(path, order, signal) {
  const headers = { "Content-Type": "application/json" };
  return answer(await fetch(address(path), { method: "POST", headers, body: JSON.stringify(order), signal }));
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
