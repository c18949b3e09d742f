// Embedded data in base 85 of gzip: a number of bytes, a space, and five letters for every four
// bytes.

// Returns the decompressed bytes of such a text, as a stream.
function unpacked(text) {
  const from = text.indexOf(" ") + 1;
  const view = new DataView(new ArrayBuffer((4 * (text.length - from)) / 5));
  for (let at = from, to = 0; at < text.length; to += 4) {
    let number = 0;
    for (const end = at + 5; at < end; at += 1) {
      const code = text.charCodeAt(at);
      number = 85 * number + code - (code > 60 ? 34 : 33);
    }
    view.setUint32(to, number);
  }
  const packed = new Uint8Array(view.buffer, 0, Number(text.slice(0, from)));
  return new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
}

// Returns the bytes that the element with an id contains.
function held(id) {
  return new Response(unpacked(document.getElementById(id).textContent)).arrayBuffer();
}
