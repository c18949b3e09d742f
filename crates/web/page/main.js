// The page: starts the engines, and joins the choices, the picture, the runs and what engineers ask for.

const find = (id) => document.getElementById(id);
document.documentElement.classList.add("js");
window.barrelstack = { started: null, marks: null };

function broken(error) {
  find("broken-text").textContent = `${error.message}\n\n${navigator.userAgent}\n\n${error.about || ""}`;
  if (!find("broken").open) find("broken").showModal();
}

async function start() {
  const [module, worker] = await Promise.all([held("engine").then((bytes) => WebAssembly.compile(bytes)), held("worker")]);
  const address = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
  const cores = navigator.hardwareConcurrency || 2;
  // One engine answers what cannot wait; the others leave a core to the page where there are enough.
  const desk = makeEngines(module, address, 1);
  const crew = makeEngines(module, address, Math.min(Math.max(cores - 1, Math.min(cores, 2)), 8));
  const players = [];
  const picture = makePicture(find("stage"), players);
  listenEverywhere(players);
  const [scenarios, catalog] = await Promise.all([desk.ask({ ask: "scenarios" }), desk.ask({ ask: "catalog" })]);
  const known = jsonOf(scenarios).map(([name, text]) => ({ name, text }));
  let cellar = makeCellar(known.find(({ name }) => name === "demo-napa")), look = null, missing = [];

  function refuse(error) {
    if (error.stopped) return;
    if (error.broken) {
      error.about = `${commandOf(cellar)}\n\n${cellar.base.own ? cellar.base.text : ""}`;
      return broken(error);
    }
    find("refused").textContent = error.message;
    find("refused").hidden = false;
  }

  // Asks what the cellar says, and shows it; gives whether it says anything.
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
    engineer.show(cellar, look);
    runs.forecast(look);
    if (missing.length > 0) find("motion").textContent = `The link is about a record that it does not hold: drop ${missing.join(", ")} here. Until then: ${find("motion").textContent}`;
  }

  // Changes the cellar at hand, shows it standing, and shakes it where that is asked for.
  async function change(write, shake) {
    write(cellar);
    if (!(await seen(cellar))) return;
    showAll();
    if (shake) {
      find("result").scrollIntoView({ block: "start" });
      runs.run();
    } else await picture.put(look.stage, { still: true });
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

  // What the base says without changes, which choices are held against.
  async function stated() {
    if (cellar.base.look === undefined && Object.keys(cellar.changes).length === 0) cellar.base.look = look;
    if (cellar.base.look === undefined) {
      const bare = { base: cellar.base, changes: {}, records: cellar.records };
      try {
        cellar.base.look = jsonOf(await desk.ask(headOf(bare, "look"), { records: bare.records, urgency: 2, group: "stated" }));
      } catch (error) {
        if (error.broken) throw error;
        // One that needs a record which is not at hand is as it is with it.
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

  const controls = makeControls(find, jsonOf(catalog), (write) => change(write, false));
  const runs = makeRuns(find, { crew, desk, picture, state, apply, change, refuse, controls });
  const engineer = makeEngineer(find, { desk, crew, state, change, open, refuse });
  makeHeights(find, { crew, desk, state, refuse });

  // A record of one's own: its bytes stay in the page.
  async function take(files) {
    const [file] = files;
    if (!file) return;
    const record = { path: file.name, bytes: new Uint8Array(await file.arrayBuffer()) };
    const tried = copied(cellar);
    tried.records = [record];
    tried.changes["motion.record"] = JSON.stringify(record.path);
    delete tried.changes["motion.scale.factor"];
    if (!(await seen(tried))) return;
    cellar = tried;
    missing = [];
    showAll();
    await picture.put(look.stage, { still: true });
    find("said").textContent = `The stack is now shaken by ${look.checked[0].motion.name}.`;
  }
  find("record").addEventListener("change", (event) => {
    take([...event.target.files]);
    event.target.value = "";
  });
  const over = (on) => document.body.classList.toggle("over", on);
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    over(true);
  });
  document.addEventListener("dragleave", () => over(false));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    over(false);
    const files = [...event.dataTransfer.files];
    const scenario = files.find(({ name }) => name.endsWith(".toml"));
    if (scenario) scenario.text().then((text) => open({ name: scenario.name, text, own: true })).catch(refuse);
    else take(files);
  });

  // What the page is given where it is part of another.
  async function fromReport() {
    const given = find("start");
    if (!given) return false;
    const { name, text, records } = JSON.parse(given.textContent);
    await open({ name, text, own: true }, { records: records.map(({ path, base64 }) => ({ path, bytes: bytesOf(base64) })) });
    return true;
  }

  async function fromAddress() {
    const link = await linked(location.hash, known);
    if (!link) return false;
    missing = link.missing;
    await open(link.cellar.base, link.cellar);
    return true;
  }
  window.addEventListener("hashchange", () => fromAddress().catch(refuse));
  let opened = false;
  try {
    opened = (await fromReport()) || (await fromAddress());
  } catch (error) {
    refuse(error);
  }
  if (!opened) await open(cellar.base, cellar);
  crew.warm();

  let width = window.innerWidth, waiting = 0;
  window.addEventListener("resize", () => {
    // Phones fire this when the address bar hides; only the width matters.
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    clearTimeout(waiting);
    waiting = setTimeout(picture.refresh, 120);
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", picture.refresh);
  find("broken-copy").addEventListener("click", () => copyText(find("broken-text").textContent));
  Object.assign(window.barrelstack, { crew, desk, runs, state, players, started: performance.now() });
}

start().catch((error) => broken(Object.assign(error, { broken: true })));
