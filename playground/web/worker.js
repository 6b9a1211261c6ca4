// The worker beside the page: runs jabuka, and answers the requests of the page between pieces of simulation.

import { Jabuka } from "./module.js";

/** The time for which the worker simulates before it looks for requests, ms. */
const PIECE = 12;
/** The smallest time between two messages about the progress of a run, ms. */
const INTERVAL = 40;
/** The time that a new run has to finish before the page shows it unfinished, ms: for another scene, and for the same one. */
const [AT_ONCE, AGAIN] = [150, 25];

/** What the module has said last, in case it ends. */
const said = [];
let jabuka;
let told = 0;
/** The version of the text that was read last. */
let version;
/** The path of the scene that was read last. */
let last;
let busy = false;
let ended = false;
const early = [];
const turn = new MessageChannel();

function end(error) {
  ended = true;
  const last = said.filter((line) => !line.startsWith("note: ")).join("\n");
  const isFull = /memory allocation/.test(last);
  self.postMessage({ broken: isFull ? "the scene needs more memory than a page may have" : last || String(error) });
}

function tell() {
  told = performance.now();
  self.postMessage({ state: { ...jabuka.json({ path: "/api/state" }), text: version } });
}

function goOn() {
  if (!busy) turn.port2.postMessage(0);
  busy = true;
}

turn.port1.onmessage = () => {
  busy = false;
  if (ended) return;
  try {
    const more = jabuka.advance(PIECE);
    if (!more || performance.now() - told > INTERVAL) tell();
    if (more) goOn();
  } catch (error) {
    end(error);
  }
};

function read({ scene, files, version: newest }) {
  self.postMessage({ began: newest });
  version = newest;
  const patience = scene === last ? AGAIN : AT_ONCE;
  last = scene;
  said.length = 0;
  jabuka.put(files);
  jabuka.read(scene);
  const begun = performance.now();
  let more;
  do {
    more = jabuka.advance(PIECE);
  } while (more && performance.now() - begun < patience);
  tell();
  if (more) goOn();
}

function answer({ id, request }) {
  try {
    const bytes = jabuka.ask(request);
    self.postMessage({ id, bytes }, [bytes.buffer]);
  } catch (error) {
    if (error.status === undefined) throw error;
    self.postMessage({ id, error: error.message, status: error.status });
  }
  if (request.variant) goOn();
}

async function take(data) {
  if (ended) return;
  try {
    if (data.module) {
      jabuka = await Jabuka.start(data.module, data.fonts, (line) => {
        said.push(line);
        if (said.length > 20) said.shift();
      });
      early.splice(0).forEach(take);
    } else if (!jabuka) early.push(data);
    else if (data.files) read(data);
    else answer(data);
  } catch (error) {
    end(error);
  }
}

self.onmessage = ({ data }) => take(data);
