// Keeps the text of the scene for the time when the same address is loaded again in this tab, so that no edit is lost.

const KEY = "scene";

/** Keeps a scene for the present address. */
export function keep(scene) {
  try {
    sessionStorage.setItem(KEY, JSON.stringify({ hash: location.hash, ...scene }));
  } catch {
    // A browser that stores nothing loses the text, as it would without this.
  }
}

/** Returns the scene that was kept for the present address, with its name and text. Null if there is none. */
export function kept() {
  try {
    const { hash, name, text } = JSON.parse(sessionStorage.getItem(KEY)) ?? {};
    return hash === location.hash && typeof name === "string" && typeof text === "string" ? { name, text } : null;
  } catch {
    return null;
  }
}
