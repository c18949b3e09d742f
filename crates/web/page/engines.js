// The engines: workers that answer requests, the most urgent first. Work that is no longer wanted
// is stopped by ending its worker, which always works.

const ROOM = 384e6; // memory (bytes) above which an engine is ended after its answer, because it never releases memory

const language = document.documentElement.lang;

// Encodes a request for the engine: the length of the head, the head, the records, and further
// data.
function requestOf(head, files) {
  const records = files.filter(({ path }) => path !== undefined);
  const text = new TextEncoder().encode(JSON.stringify({ ...head, language, records: records.map(({ path, bytes }) => [path, bytes.length]) }));
  const request = new Uint8Array(4 + text.length + files.reduce((sum, { bytes }) => sum + bytes.length, 0));
  new DataView(request.buffer).setUint32(0, text.length, true);
  request.set(text, 4);
  let at = 4 + text.length;
  for (const { bytes } of files) {
    request.set(bytes, at);
    at += bytes.length;
  }
  return request;
}

// Unpacks and compiles the module in a worker, so that the page is not blocked.
function compiled(address, packed) {
  return new Promise((resolve, reject) => {
    const worker = new Worker(address);
    worker.onmessage = ({ data: { module, refused } }) => {
      worker.terminate();
      if (module) resolve(module);
      else reject(new Error(refused));
    };
    worker.onerror = (event) => reject(new Error(event.message || t("the engine does not start")));
    worker.postMessage({ packed });
  });
}

// Creates up to `most` engines, each started when there is work for it; the module may still be
// loading.
function makeEngines(module, address, most) {
  const all = new Set();
  let waiting = [];

  function start() {
    const one = { worker: new Worker(address), job: null, ready: false };
    one.worker.onmessage = ({ data }) => hear(one, data);
    one.worker.onerror = (event) => fail(one, event.message || t("the engine does not start"));
    module.then((module) => one.worker.postMessage({ module }), (error) => {
      end(one);
      for (const job of waiting.splice(0)) job.reject(Object.assign(new Error(error.message), { broken: true }));
    });
    all.add(one);
  }

  function end(one) {
    one.worker.terminate();
    all.delete(one);
  }

  function fail(one, text) {
    const { job } = one;
    end(one);
    if (job) job.reject(Object.assign(new Error(text), { broken: true }));
    next();
  }

  function hear(one, data) {
    if (data.ready) one.ready = true;
    else if (data.of !== undefined) {
      if (one.job && one.job.told) one.job.told(data.done, data.of);
      return;
    } else {
      const { job } = one;
      if (data.status === 2) return fail(one, `${new TextDecoder().decode(data.answer) || t("no words")} (${data.trap})`);
      one.job = null;
      if (data.memory > ROOM) end(one);
      if (data.status === 0) job.resolve({ bytes: data.answer, said: data.said, took: data.took, memory: data.memory });
      else job.reject(new Error(new TextDecoder().decode(data.answer)));
    }
    next();
  }

  function next() {
    const idle = [...all].filter(({ ready, job }) => ready && !job);
    for (const one of idle) {
      if (waiting.length === 0) return;
      one.job = waiting.shift();
      const request = one.job.request();
      one.worker.postMessage({ request, draws: one.job.draws }, [request.buffer]);
    }
    const starting = [...all].filter(({ ready }) => !ready).length;
    for (let more = waiting.length - starting; more > 0 && all.size < most; more -= 1) start();
  }

  return {
    most,
    // Starts engines before there is work for them.
    warm() {
      while (all.size < most) start();
    },
    // Returns an answer in bytes, or as `said` if it `draws` a picture. `group` identifies the work
    // for stopping; `told` receives the progress.
    ask(head, { records = [], urgency = 0, group = "", told, draws } = {}) {
      return new Promise((resolve, reject) => {
        const job = { request: () => requestOf(head, records), urgency, group, told, draws, resolve, reject };
        const at = waiting.findIndex((other) => other.urgency < urgency);
        waiting.splice(at < 0 ? waiting.length : at, 0, job);
        next();
      });
    },
    // Stops all work of a group.
    stop(group) {
      const stopped = Object.assign(new Error("stopped"), { stopped: true });
      const dropped = waiting.filter((job) => job.group === group);
      waiting = waiting.filter((job) => job.group !== group);
      for (const one of [...all]) {
        if (one.job && one.job.group === group) {
          dropped.push(one.job);
          end(one);
        }
      }
      for (const job of dropped) job.reject(stopped);
      next();
    },
  };
}

const jsonOf = ({ said, bytes }) => said || JSON.parse(new TextDecoder().decode(bytes));

// Returns an answer that has bytes after its head.
function partsOf({ bytes }) {
  const end = 4 + new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  return { head: JSON.parse(new TextDecoder().decode(bytes.subarray(4, end))), rest: bytes.subarray(end) };
}
