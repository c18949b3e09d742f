// "Try a change": opens the embedded page in a frame over the report, with the scenario of the
// report.
{
  const dialog = document.getElementById("trial");
  let opened = false;
  document.getElementById("try").addEventListener("click", async () => {
    dialog.showModal();
    if (opened) return;
    opened = true;
    const text = new TextDecoder().decode(await held("trial-page"));
    const start = document.getElementById("trial-start").textContent;
    const frame = make("iframe", { title: t("The program") });
    frame.srcdoc = text.replace("<body>", () => `<body><script type="application/json" id="start">${start}<\/script>`);
    dialog.append(frame);
  });
}
