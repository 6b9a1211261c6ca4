// Unpacks files that a source sends together, such as the scripts of a run.

/** Yields the name and the bytes of each file. */
export function* unpacked(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 0;
  const take = () => {
    const length = view.getUint32(at, true);
    at += 4 + length;
    return bytes.subarray(at - length, at);
  };
  while (at < bytes.length) {
    const name = new TextDecoder().decode(take());
    yield [name, take()];
  }
}
