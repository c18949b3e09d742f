// An engine in a worker: unpacks and compiles the module, or receives it, then answers requests one
// after the other and reports its progress. The functions `unpacked` and `unpack` of the page
// precede this script.

let engine = null, last = 0;
const bytes = (address, length) => new Uint8Array(engine.memory.buffer, address, length);

// Reports progress, at most as often as a screen is redrawn.
function progress(done, of) {
  const now = performance.now();
  if (now - last > 60) {
    last = now;
    postMessage({ done, of });
  }
  return 0;
}

// Decodes the numbers of a picture here, so that the page is not blocked; their buffers are
// transferred to the page.
function drawn(value, buffers) {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return typeof value[0] === "object" ? value.map((one) => drawn(one, buffers)) : value;
  if (typeof value.d !== "string") return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, drawn(one, buffers)]));
  const channels = unpack(value);
  buffers.push(...channels.map(({ buffer }) => buffer));
  return channels;
}

function answer(request, draws) {
  const from = performance.now();
  let status = 2, trap = "";
  try {
    bytes(engine.room(request.length), request.length).set(request);
    status = engine.run();
  } catch (error) {
    trap = String(error);
  }
  const answer = bytes(engine.answer(), engine.answer_length()).slice();
  const about = { status, trap, memory: engine.memory.buffer.byteLength, took: performance.now() - from };
  if (status !== 0 || !draws) return postMessage({ ...about, answer }, [answer.buffer]);
  const said = JSON.parse(new TextDecoder().decode(answer)), buffers = [];
  said.stage.data = drawn(JSON.parse(said.stage.data), buffers);
  postMessage({ ...about, said }, buffers);
}

onmessage = async ({ data: { packed, module, request, draws } }) => {
  if (request) return answer(request, draws);
  if (module) {
    engine = (await WebAssembly.instantiate(module, { page: { progress } })).exports;
    return postMessage({ ready: true });
  }
  try {
    const response = new Response(unpacked(packed), { headers: { "content-type": "application/wasm" } });
    postMessage({ module: await WebAssembly.compileStreaming(response) });
  } catch (error) {
    postMessage({ refused: String(error) });
  }
};
