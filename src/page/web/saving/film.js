// Encodes a film of a run, frame by frame: each frame is drawn, then encoded, so none is dropped.

import { open } from "../parts.js";
import { Snapshots } from "./snapshots.js";

/** The codecs of each format, the preferred ones first. */
const CODECS = { mp4: ["avc", "hevc", "vp9", "av1"], webm: ["vp9", "vp8", "av1"] };
export const FORMATS = { mp4: "MP4", webm: "WebM" };

/** The frame rates at which a film can be watched, per second, and the rate of a film whose scene has another one. The program has the same. */
const [SLOWEST, FASTEST, USUAL] = [1, 120, 25];

/** True if the browser can encode films at all. */
export const CAN_ENCODE = typeof VideoEncoder === "function";

/** Returns the format that the browser can encode and that most players know. */
export async function usualFormat() {
  const { supported } = await VideoEncoder.isConfigSupported({ codec: "avc1.42001f", width: 640, height: 360 }).catch(() => ({}));
  return supported ? "mp4" : "webm";
}

/** Returns the frame rate of the film of a run, per second. */
export function filmRate({ rate }) {
  return rate >= SLOWEST && rate <= FASTEST ? rate : USUAL;
}

/** Lets the page react to its user, also while it is hidden. */
function breathe() {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => (port1.close(), resolve());
    port2.postMessage(null);
  });
}

/**
 * Returns a film of the frames `from` to `to` of the shown run, `width` x `height` pixels large. `tell` receives the part that is done, from 0 to 1.
 * `signal` ends the work.
 */
export async function filmFile({ width, height, format, from, to }, { tell, signal }) {
  const { BufferTarget, CanvasSource, Mp4OutputFormat, Output, Quality, WebMOutputFormat, getFirstEncodableVideoCodec } = await import("../libraries/video.js");
  const rate = filmRate(open.run);
  const quality = new Quality("very-high");
  const codec = await getFirstEncodableVideoCodec(CODECS[format], { width, height, quality, frameRate: rate });
  if (!codec) throw new Error(`This browser cannot encode ${FORMATS[format]} with ${width} × ${height} pixels: choose another format or size.`);
  const shots = new Snapshots({ width, height });
  const output = new Output({ format: format === "mp4" ? new Mp4OutputFormat() : new WebMOutputFormat(), target: new BufferTarget() });
  try {
    await shots.begin();
    const track = new CanvasSource(shots.canvas, { codec, quality });
    output.addVideoTrack(track, { frameRate: rate });
    await output.start();
    for (let frame = from; frame <= to; frame++) {
      await shots.take(frame);
      await track.add((frame - from) / rate, 1 / rate);
      tell((frame + 1 - from) / (to + 1 - from));
      await breathe();
      signal.throwIfAborted();
    }
    await output.finalize();
  } catch (error) {
    await output.cancel();
    throw error;
  } finally {
    shots.end();
  }
  return new Blob([output.target.buffer], { type: `video/${format}` });
}
