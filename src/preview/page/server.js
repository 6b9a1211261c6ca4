// What the server says. Every path but those of the page itself asks for the token that stands in the address.

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

/** Sends an order, and gives what the server answers. */
export async function post(path, order, signal) {
  const headers = { "Content-Type": "application/json" };
  return answer(await fetch(address(path), { method: "POST", headers, body: JSON.stringify(order), signal }));
}

/**
 * Calls `changed` with the state of the server, now and whenever it changes; `lost` when the server is gone. A page that
 * nobody sees does not listen: a browser has few connections to one server.
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
