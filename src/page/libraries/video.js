// What the recorder of films uses of Mediabunny.

export { BufferTarget, CanvasSource, Mp4OutputFormat, Output, Quality, WebMOutputFormat, getFirstEncodableVideoCodec } from "mediabunny";
