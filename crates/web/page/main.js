// The page: starts the engines, and connects the choices, the picture, the runs and the section for
// engineers.

const find = (id) => document.getElementById(id);
document.documentElement.classList.add("js");
// Times (ms) since the page was requested at which it can be used, and at which an engine is ready.
window.barrelstack = { started: null, ready: null, marks: null };

function broken(error) {
  find("broken-text").textContent = `${error.message}\n\n${navigator.userAgent}\n\n${error.about || ""}`;
  if (!find("broken").open) find("broken").showModal();
}

// Returns the text of an element that follows the scripts.
async function later(id) {
  if (!find(id)) await new Promise((done) => document.addEventListener("DOMContentLoaded", done, { once: true }));
  return find(id).textContent;
}

async function start() {
  const first = JSON.parse(new TextDecoder().decode(await held("first")));
  // Functions that the workers share with the page precede their own script.
  const shared = [bytesOf, unpack, unpacked].map(String);
  const address = URL.createObjectURL(new Blob([...shared, find("worker").textContent], { type: "text/javascript" }));
  const module = later("engine").then((packed) => compiled(address, packed));
  const cores = navigator.hardwareConcurrency || 2;
  // One engine answers urgent requests; the others leave one core to the page if there are enough.
  const desk = makeEngines(module, address, 1);
  const crew = makeEngines(module, address, Math.min(Math.max(cores - 1, Math.min(cores, 2)), 8));
  const players = [];
  const picture = makePicture(find("stage"), players);
  listenEverywhere(players);
  let cellar = makeCellar({ name: first.name, text: first.text, look: first.look }), look = first.look, missing = [];

  function refuse(error) {
    if (error.stopped) return;
    if (error.broken) {
      error.about = `${commandOf(cellar)}\n\n${cellar.base.own ? cellar.base.text : ""}`;
      return broken(error);
    }
    find("refused").textContent = error.message;
    find("refused").hidden = false;
  }

  // Resolves the cellar and shows it; returns whether it is valid.
  let asked = 0;
  async function seen(of) {
    const own = (asked += 1);
    desk.stop("look");
    try {
      const answer = await desk.ask(headOf(of, "look"), { records: of.records, urgency: 2, group: "look" });
      if (own !== asked) return false;
      look = jsonOf(answer);
      find("refused").hidden = true;
      find("go").disabled = false;
      return true;
    } catch (error) {
      if (own !== asked || error.stopped) return false;
      find("go").disabled = true;
      refuse(error);
      return false;
    }
  }

  const state = () => ({ cellar, look });

  function showAll() {
    controls.show(look);
    engineer.show();
    runs.forecast(look);
    if (missing.length > 0) find("motion").textContent = t("The link refers to a record that it does not contain: drop {1} here. Until then: {2}", missing.join(", "), find("motion").textContent);
  }

  // Changes the current cellar, shows the stack at rest and, if requested, shakes it and returns
  // the run.
  async function change(write, shake) {
    write(cellar);
    if (!(await seen(cellar))) return null;
    showAll();
    if (!shake) return picture.put(look.stage, { still: true });
    find("result").scrollIntoView({ block: "start" });
    return runs.run();
  }

  async function apply(other, lookOfIt) {
    asked += 1;
    cellar = other;
    look = lookOfIt;
    find("refused").hidden = true;
    find("go").disabled = false;
    await stated();
    showAll();
  }

  // Resolves the base without changes, with which the choices are compared.
  async function stated() {
    if (cellar.base.look === undefined && Object.keys(cellar.changes).length === 0) cellar.base.look = look;
    if (cellar.base.look === undefined) {
      const bare = { base: cellar.base, changes: {}, records: cellar.records };
      try {
        cellar.base.look = jsonOf(await desk.ask(headOf(bare, "look"), { records: bare.records, urgency: 2, group: "stated" }));
      } catch (error) {
        if (error.broken) throw error;
        // If the base needs a record that is missing, its values with the record are used.
        cellar.base.look = look;
      }
    }
    controls.state(cellar.base.look);
  }

  async function open(base, others = {}) {
    const next = { base, changes: {}, records: cellar.records, ...others };
    if (!(await seen(next))) return;
    cellar = next;
    await stated();
    showAll();
    await picture.put(look.stage, { still: true });
  }

  // Uses a motion that the reader gave; returns the resolved stack under that motion.
  async function shake(motion) {
    const tried = shakenBy(cellar, motion);
    if (!(await seen(tried))) return null;
    cellar = tried;
    missing = [];
    showAll();
    picture.put(look.stage, { still: true }).catch(refuse);
    return look;
  }

  const controls = makeControls(find, first.catalog, (write) => change(write, false));
  const { writers, states } = controls;
  const devices = makeDevices(find, { crew, desk, change, writers, states, refuse, lasts: (...of) => runs.lasts(...of) });
  const runs = makeRuns(find, { crew, desk, picture, state, apply, change, refuse, controls, devices });
  const engineer = makeEngineer(find, { desk, crew, state, change, open, refuse, tallyOf: runs.tallyOf });
  const records = makeRecords(find, { desk, shake, refuse });
  makeHeights(find, { crew, desk, state, refuse, writers, motionsOf: records.all });

  find("record").addEventListener("change", (event) => {
    records.given([...event.target.files]);
    event.target.value = "";
  });
  // The page in the other language opens with the same stack.
  const other = document.querySelector(`.languages a:not(:lang(${language}))`);
  other.hidden = Boolean(find("start"));
  other.addEventListener("click", async (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    location.href = other.getAttribute("href") + (await linkOf(cellar));
  });
  const over = (on) => document.body.classList.toggle("over", on);
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  document.addEventListener("dragleave", () => over(false));
  document.addEventListener("drop", async (event) => {
    event.preventDefault();
    over(false);
    try {
      const files = await filesIn(event.dataTransfer);
      const scenario = files.find(({ name }) => name.endsWith(".toml"));
      if (scenario) await open({ name: scenario.name, text: await scenario.text(), own: true });
      else await records.given(files);
    } catch (error) {
      refuse(error);
    }
  });

  // Reads the data that an embedding report passes to the page.
  async function fromReport() {
    const given = find("start");
    if (!given) return false;
    const { name, text, records } = JSON.parse(given.textContent);
    await open({ name, text, own: true }, { records: records.map(({ path, base64 }) => ({ path, bytes: bytesOf(base64) })) });
    return true;
  }

  async function fromAddress() {
    if (!location.hash.startsWith("#s=")) return false;
    const known = jsonOf(await desk.ask({ ask: "scenarios" })).map(([name, text]) => ({ name, text }));
    const link = await linked(location.hash, known);
    if (!link) return false;
    missing = link.missing;
    await open(link.cellar.base, link.cellar);
    return true;
  }
  window.addEventListener("hashchange", () => fromAddress().catch(refuse));
  // Answers embedded in the page are available before an engine is.
  const opening = async () => {
    try {
      if ((await fromReport()) || (await fromAddress())) return;
    } catch (error) {
      refuse(error);
    }
    await stated();
    showAll();
    find("go").disabled = false;
    await picture.put(look.stage, { still: true });
  };

  let width = window.innerWidth, waiting = 0;
  window.addEventListener("resize", () => {
    // Phones fire this event when the address bar hides; only a change of the width matters.
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    clearTimeout(waiting);
    waiting = setTimeout(picture.refresh, 120);
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", picture.refresh);
  find("broken-copy").addEventListener("click", () => copyText(find("broken-text").textContent));
  Object.assign(window.barrelstack, { crew, desk, runs, state, players });
  await opening();
  window.barrelstack.started = performance.now();
  try {
    await module;
    crew.warm();
    await desk.ask({ ask: "catalog" });
    window.barrelstack.ready = performance.now();
  } catch (error) {
    refuse(Object.assign(error, { broken: true }));
  }
}

start().catch((error) => broken(Object.assign(error, { broken: true })));
