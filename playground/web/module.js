// The WebAssembly module of jabuka, with a virtual folder for the files of a scene. It works in browsers and in Node.

import { ConsoleStdout, Directory, File, OpenFile, PreopenDirectory, WASI } from "@bjorn3/browser_wasi_shim";

/** The number of the module's answer if all is well. */
const GOOD = 200;

/** Errors of WASI: this is no link; there is no such file. */
const [NO_LINK, NO_FILE] = [28, 44];

export class Jabuka {
  /**
   * Starts the module with the contents of the files of the fonts. `say` receives what it writes to standard error, a line at a time.
   */
  static async start(module, fonts, say = console.warn) {
    const folder = new PreopenDirectory(".", new Map());
    const output = ConsoleStdout.lineBuffered(say);
    const wasi = new WASI([], [], [new OpenFile(new File([])), output, output, folder], { debug: false });
    const jabuka = new Jabuka(folder);
    // The virtual folder has no links. The library says so only by an error that makes all paths unknown.
    const path_readlink = (_, at, length) => {
      const path = new TextDecoder().decode(new Uint8Array(jabuka.exports.memory.buffer, at, length));
      return jabuka.has(path) ? NO_LINK : NO_FILE;
    };
    const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: { ...wasi.wasiImport, path_readlink } });
    wasi.initialize(instance);
    jabuka.exports = instance.exports;
    const [regular, bold] = fonts;
    const at = jabuka.exports.room(regular.length + bold.length);
    const place = new Uint8Array(jabuka.exports.memory.buffer, at, regular.length + bold.length);
    place.set(regular);
    place.set(bold, regular.length);
    jabuka.exports.take_fonts(regular.length);
    return jabuka;
  }

  constructor(folder) {
    this.folder = folder;
  }

  /** Returns true if the virtual folder has a file or a folder at this path. */
  has(path) {
    const names = path.split("/").filter((name) => name && name !== ".");
    return Boolean(names.reduce((entry, name) => entry?.contents?.get?.(name), this.folder.dir));
  }

  /** Replaces all files of the virtual folder. `files` has the bytes or the text of each, by its path. */
  put(files) {
    const root = new Map();
    for (const [path, contents] of Object.entries(files)) {
      const names = path.split("/");
      let entries = root;
      for (const name of names.slice(0, -1)) {
        if (!entries.has(name)) entries.set(name, new Directory(new Map()));
        entries = entries.get(name).contents;
      }
      const bytes = typeof contents === "string" ? new TextEncoder().encode(contents) : contents;
      entries.set(names.at(-1), new File(bytes, { readonly: true }));
    }
    this.folder.dir.contents = root;
  }

  /** Answers a request of the page. Returns its bytes; if it fails, throws an error with a `status`. */
  ask(request) {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    const { exports } = this;
    const at = exports.room(bytes.length);
    new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
    const status = exports.ask();
    const answer = new Uint8Array(exports.memory.buffer, exports.answer(), exports.answer_length()).slice();
    if (status === GOOD) return answer;
    const error = new Error(new TextDecoder().decode(answer).trim());
    error.status = status;
    throw error;
  }

  /** Reads the scene with this path in the virtual folder, and returns the state. */
  read(scene) {
    return this.json({ path: "/api/state", scene });
  }

  json(request) {
    return JSON.parse(new TextDecoder().decode(this.ask(request)));
  }

  /** Simulates for about some milliseconds. Returns true if there is more to simulate. */
  advance(milliseconds) {
    return this.exports.advance(milliseconds) !== 0;
  }
}
