// For the engineer: every field, the text, the command, the link, and the report with its files.

// `change` writes into the current cellar and resolves it; `open` takes another base; `tallyOf`
// returns the known results of the variants of a cellar.
function makeEngineer(find, { desk, crew, state, change, open, refuse, tallyOf }) {
  const rows = new Map();

  function field({ path, help }) {
    const input = make("input", { type: "text", "aria-label": path, spellcheck: "false" }), from = make("td");
    const wrong = make("span", { class: "wrong", role: "alert" });
    const row = make("tr", {}, make("td", {}, path), make("td", {}, input, wrong), make("td", {}, help), from);
    let waiting = 0;
    input.addEventListener("input", () => {
      clearTimeout(waiting);
      waiting = setTimeout(async () => {
        const { cellar } = state();
        const tried = copied(cellar);
        // A value that is not valid TOML is a text, as on the command line; an empty value restores
        // the field.
        const write = ({ changes }) => {
          if (input.value.trim() === "") delete changes[path];
          else changes[path] = input.value;
        };
        write(tried);
        try {
          await desk.ask(headOf(tried, "look"), { records: tried.records, group: "field" });
          wrong.textContent = "";
          change(write, false);
        } catch (error) {
          if (error.broken) refuse(error);
          else if (!error.stopped) wrong.textContent = error.message;
        }
      }, 250);
    });
    rows.set(path, { row, input, wrong, from, words: `${path} ${help}`.toLowerCase() });
    return row;
  }

  function filter() {
    const wanted = find("filter").value.toLowerCase();
    for (const { row, words } of rows.values()) row.hidden = !words.includes(wanted);
  }

  // Fields appear, disappear and move as other fields change. Existing rows are kept in place,
  // because the reader may be typing into one of them.
  function listFields(settings) {
    const paths = new Set(settings.map(({ path }) => path));
    for (const [path, { row }] of rows) {
      if (paths.has(path)) continue;
      row.remove();
      rows.delete(path);
    }
    let before = null;
    for (const setting of settings) {
      const known = rows.get(setting.path)?.row, row = known || field(setting);
      if (!known) find("field-rows").insertBefore(row, before ? before.nextSibling : find("field-rows").firstChild);
      before = row;
    }
    filter();
  }

  // Shows a resolved scenario when the section is open; text being typed is kept.
  function show() {
    if (!find("engineer-fold").open) return;
    const { cellar, look } = state();
    listFields(look.settings);
    for (const { path, value, source } of look.settings) {
      const { input, wrong, from, row } = rows.get(path);
      from.textContent = source;
      if (document.activeElement !== input) {
        input.value = value;
        wrong.textContent = "";
      }
      row.classList.toggle("changed", Object.keys(cellar.changes).some((changed) => changed === path || path.startsWith(`${changed}.`)));
    }
    find("command").textContent = commandOf(cellar);
    if (document.activeElement !== find("text")) {
      find("text").value = look.resolved;
      find("text-take").disabled = true;
      say("text-said", "");
    }
  }

  function say(id, text, bad) {
    find(id).textContent = text;
    find(id).classList.toggle("bad", Boolean(bad));
  }

  find("engineer-fold").addEventListener("toggle", show);
  let checking = 0;
  find("text").addEventListener("input", () => {
    clearTimeout(checking);
    checking = setTimeout(async () => {
      const tried = { base: { name: "mine.toml", text: find("text").value, own: true }, changes: {}, records: state().cellar.records };
      try {
        await desk.ask(headOf(tried, "look"), { records: tried.records, group: "text" });
        say("text-said", t("The text is valid."));
        find("text").removeAttribute("aria-invalid");
        find("text-take").disabled = false;
      } catch (error) {
        if (error.broken) return refuse(error);
        if (error.stopped) return;
        say("text-said", error.message, true);
        find("text").setAttribute("aria-invalid", "true");
        find("text-take").disabled = true;
        reveal(error.message);
      }
    }, 300);
  });

  // Scrolls to the line of an error.
  function reveal(message) {
    const at = /mine\.toml:(\d+)/.exec(message);
    if (!at) return;
    const box = find("text"), lines = box.value.split("\n").length;
    box.scrollTop = Math.max(0, ((Number(at[1]) - 4) * box.scrollHeight) / lines);
  }

  find("text-take").addEventListener("click", () => open({ name: "mine.toml", text: find("text").value, own: true }));
  find("filter").addEventListener("input", filter);
  find("import").addEventListener("change", async (event) => {
    const [file] = event.target.files;
    if (file) open({ name: file.name, text: await file.text(), own: true });
    event.target.value = "";
  });
  find("text-save").addEventListener("click", () => save("scenario.toml", "text/plain", [state().look.resolved]));

  function save(name, type, parts) {
    const link = make("a", { download: name, href: URL.createObjectURL(new Blob(parts, { type })) });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  find("link").addEventListener("click", async () => {
    const link = location.href.replace(/#.*/, "") + (await linkOf(state().cellar));
    const done = await copyText(link);
    const kept = state().cellar.records.length > 0 ? ` ${t("The link contains only the name of your record.")}` : "";
    find("link-said").textContent = (done ? t("Copied.") : t("The link is the address of this page.")) + kept;
    setHash(link);
  });

  function busy(on) {
    find("report-stop").hidden = !on;
    find("report-go").hidden = on;
  }

  find("report-go").addEventListener("click", async () => {
    const { look } = state(), cellar = copied(state().cellar);
    busy(true);
    try {
      // The results of the variants are known, or are computed by all engines; the shown run is
      // computed by one engine.
      const tally = tallyOf(cellar);
      const said = (what) => (done, of) => { find("report-said").textContent = `${what}: ${percentOf(of > 0 ? done / of : 0)}`; };
      const heard = (_, count) => said(t("variants"))(count - 1, look.variants);
      if (look.variants > 0) await runAll({ crew, cellar, tally, count: look.variants, group: "report", heard });
      const trails = { bytes: new Uint8Array(await new Blob(tally.trails).arrayBuffer()) };
      const known = look.variants > 0 ? { ...tally.given(), trails: trails.bytes.length } : {};
      const files = look.variants > 0 ? [...cellar.records, trails] : cellar.records;
      showFiles(filesOf(await crew.ask(headOf(cellar, "files", known), { records: files, urgency: 1, group: "report", told: said(t("the run that is shown")) })));
      find("report-said").textContent = "";
    } catch (error) {
      find("report-said").textContent = "";
      if (!error.stopped) refuse(error);
    }
    busy(false);
  });
  find("report-stop").addEventListener("click", () => {
    crew.stop("report");
    desk.stop("report");
  });

  function showFiles(files) {
    window.barrelstack.files = files;
    find("files").hidden = false;
    find("files").replaceChildren(...files.map(([name, bytes]) => {
      const button = make("button", { type: "button", class: "tool" }, `${name} (${(bytes.length / 1e6).toFixed(bytes.length < 1e5 ? 2 : 1)} MB)`);
      button.addEventListener("click", () => save(name, "application/octet-stream", [bytes]));
      return make("li", {}, button);
    }));
    const [, page] = files.find(([name]) => name === "report.html");
    find("report").hidden = false;
    find("report").srcdoc = new TextDecoder().decode(page);
  }

  return { show };
}

// Returns the files in an answer, which begins with their list.
function filesOf(answer) {
  const { head, rest } = partsOf(answer);
  let at = 0;
  return head.map(([name, size]) => {
    at += size;
    return [name, rest.slice(at - size, at)];
  });
}

// Browsers offer the clipboard only to pages from a secure origin; the old method works everywhere
// else.
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const box = make("textarea", { "aria-hidden": "true", style: "position:fixed;opacity:0" });
    box.value = text;
    document.body.append(box);
    box.select();
    const done = document.execCommand("copy");
    box.remove();
    return done;
  }
}

function setHash(link) {
  try {
    history.replaceState(null, "", link);
  } catch {
    // An embedded page has no address of its own.
  }
}
