// What the recorder of films uses of Mediabunny.

export { BufferTarget, CanvasSource, Output, WebMOutputFormat, Mp4OutputFormat, getFirstEncodableVideoCodec } from "mediabunny";
