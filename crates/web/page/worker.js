// An engine in a worker: takes the module, then requests one after the other; says how far it is, and answers.

let engine = null, last = 0;
const bytes = (address, length) => new Uint8Array(engine.memory.buffer, address, length);

// How far the work is; not more often than a screen is drawn anew.
function told(done, of) {
  const now = performance.now();
  if (now - last > 60) {
    last = now;
    postMessage({ done, of });
  }
  return 0;
}

onmessage = async ({ data: { module, request } }) => {
  if (module) {
    engine = (await WebAssembly.instantiate(module, { page: { told } })).exports;
    postMessage({ ready: true });
    return;
  }
  const from = performance.now();
  let status = 2, trap = "";
  try {
    bytes(engine.room(request.length), request.length).set(request);
    status = engine.run();
  } catch (error) {
    trap = String(error);
  }
  const answer = bytes(engine.answer(), engine.answer_length()).slice();
  const memory = engine.memory.buffer.byteLength;
  postMessage({ status, trap, answer, memory, took: performance.now() - from }, [answer.buffer]);
};
