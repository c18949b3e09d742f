// Interactive plots: readout, linked cursor and zoom, built on uPlot.

const STEPS = [];
for (let n = -12; n <= 12; n++) for (const f of [1, 2, 5]) STEPS.push(Number(`${f}e${n}`));

function makePlot(raw, columns, figure, page) {
  const live = figure.querySelector(".live");
  // Numbers are decoded when the plot is first visible.
  const series = raw.series.map((s) => ({
    ...s, shown: true,
    get xs() { return columns(s.x); },
    get ys() { return columns(s.y); },
  }));
  const listed = (values) => Array.from(values, (v) => (isFinite(v) ? v : null));
  let table = null, full = [0, 1];
  function read() {
    const one = raw.series.every((s) => s.x === raw.series[0].x);
    table = one
      ? [listed(series[0].xs), ...series.map((s) => listed(s.ys))]
      : uPlot.join(series.map((s) => [listed(s.xs), listed(s.ys)]));
    full = raw.x.range || [table[0][0], table[0][table[0].length - 1]];
  }
  const values = [];
  const reset = make("button", { type: "button", class: "reset" }, t("Reset zoom"));
  reset.hidden = true;
  const at = make("output", { class: "at" });
  const legend = make("ul", { class: "legend" });
  const box = make("div", {
    class: "canvas", tabindex: "0", role: "group",
    "aria-label": t("Plot of {1} over {2}. Arrow keys move the cursor, plus and minus zoom, 0 shows all.", raw.y.title, raw.x.title),
  });
  const head = make("div", { class: "head" }, legend, reset);
  live.append(head, box);
  let plot = null, playhead = null, cursor = null, quiet = false, wanted = null;

  series.forEach((s, k) => {
    const value = make("span", { class: "value" });
    values.push(value);
    const swatch = svg("svg", { viewBox: "0 0 28 8", class: "swatch", "aria-hidden": "true" },
      ...(s.points ? [] : [svg("line", { x1: 1, y1: 4, x2: 27, y2: 4, class: s.muted ? "series muted" : `series s${s.look}`,
        "stroke-dasharray": s.dash })]),
      ...(s.dots || s.points ? [svg("circle", { cx: 14, cy: 4, r: 2.6, class: `dot s${s.look}` })] : []));
    const button = make("button", { type: "button", "aria-pressed": "true" }, swatch, s.label, value);
    button.addEventListener("click", () => {
      s.shown = !s.shown;
      button.setAttribute("aria-pressed", String(s.shown));
      plot.setSeries(k + 1, { show: s.shown });
    });
    legend.append(make("li", {}, button));
  });
  legend.append(make("li", {}, at));

  function readout(x) {
    cursor = x;
    if (x === null || !isFinite(x)) {
      at.textContent = "";
      for (const value of values) value.textContent = "";
      return;
    }
    at.textContent = `${raw.x.label ? raw.x.label + " " : ""}${told(x, raw.x, plot && plot.scales.x, 4)}`;
    series.forEach((s, k) => {
      values[k].textContent = s.xs.length ? told(s.ys[nearest(s.xs, x)], raw.y, plot && plot.scales.y, 3) : "";
    });
  }

  function options() {
    const font = "12px system-ui, sans-serif";
    const ink = color("ink"), soft = color("soft"), grid = color("grid");
    const axis = (spec, extra) => ({
      stroke: soft, font, labelFont: font, label: spec.title || undefined, labelSize: 20,
      grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, size: 4, width: 1 },
      ...(spec.log ? { values: (u, splits) => splits.map((v) => (v === null ? "" : shortLog(v))) }
        : { incrs: STEPS, values: (u, splits, i, space, step) => splits.map((v) => plain(v, step)) }),
      ...extra,
    });
    const narrow = live.clientWidth < 520;
    return {
      width: Math.max(200, live.clientWidth), height: narrow ? 220 : 260,
      padding: [10, 10, 0, 0],
      legend: { show: false },
      scales: {
        x: { time: false, distr: raw.x.log ? 3 : 1 },
        y: { distr: raw.y.log ? 3 : 1, ...(raw.y.range ? { range: raw.y.range } : {}) },
      },
      axes: [axis(raw.x, { size: 34, space: 60 }), axis(raw.y, { size: narrow ? 46 : 58, space: 36, labelGap: 0 })],
      series: [{}, ...series.map((s) => ({
        label: s.label, show: s.shown, spanGaps: false,
        stroke: s.muted ? soft : color("s" + s.look), width: s.muted ? 0.8 : 1.7,
        alpha: s.muted ? 0.6 : 1,
        dash: s.dash.split(" ").filter(Boolean).map(Number),
        fill: s.area ? color("s" + s.look) + "28" : undefined,
        points: { show: s.dots || s.points, size: 6 },
        ...(s.points ? { paths: () => null } : {}),
      }))],
      cursor: {
        drag: { x: true, y: false, dist: 4 },
        y: false,
        points: { size: 7 },
        ...(raw.timeline ? { sync: { key: "barrelstack-time", scales: ["x", null] } } : {}),
      },
      hooks: {
        drawClear: [drawBands],
        draw: [(u) => drawMarks(u, ink, soft)],
        setCursor: [(u) => {
          if (u.cursor.left >= 0) readout(u.posToVal(u.cursor.left, "x"));
          else readout(raw.timeline && page.player ? page.player.time() : null);
        }],
        setScale: [(u, key) => { if (key === "x") zoomed(u); }],
        ready: [(u) => {
          playhead = make("div", { class: "playhead" });
          u.over.append(playhead);
          place();
        }],
      },
    };
  }

  function zoomed(u) {
    const { min, max } = u.scales.x;
    const isFull = min <= full[0] + 1e-9 && max >= full[1] - 1e-9;
    reset.hidden = isFull;
    place();
    if (raw.timeline && !quiet) {
      for (const other of page.plots) if (other !== api && other.timeline) other.zoom(min, max);
    }
  }

  function zoom(min, max) {
    // A plot that is not built yet takes the range when it is built.
    wanted = [min, max];
    if (!plot) return;
    quiet = true;
    plot.setScale("x", { min, max });
    quiet = false;
  }

  function place() {
    if (!playhead || !plot) return;
    const on = raw.timeline && page.player;
    const x = on ? plot.valToPos(page.player.time(), "x") : -1;
    const inside = on && x >= 0 && x <= plot.over.clientWidth;
    playhead.hidden = !inside;
    if (inside) playhead.style.transform = `translateX(${x - 1}px)`;
  }

  function drawBands(u) {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.fillStyle = color("band");
    for (const band of raw.bands) {
      const from = Math.max(u.valToPos(band.from, "x", true), bbox.left);
      const to = Math.min(u.valToPos(band.to, "x", true), bbox.left + bbox.width);
      if (to > from) ctx.fillRect(from, bbox.top, to - from, bbox.height);
    }
    ctx.restore();
  }

  function drawMarks(u, ink, soft) {
    const { ctx, bbox } = u;
    const dpr = window.devicePixelRatio || 1;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.strokeStyle = ctx.fillStyle = soft;
    ctx.font = `${11 * dpr}px system-ui, sans-serif`;
    ctx.lineWidth = dpr;
    ctx.setLineDash([3 * dpr, 3 * dpr]);
    const line = (x0, y0, x1, y1) => {
      ctx.beginPath();
      ctx.moveTo(x0, y0);
      ctx.lineTo(x1, y1);
      ctx.stroke();
    };
    const label = (text, x, y, align) => {
      ctx.textAlign = align;
      ctx.textBaseline = "top";
      ctx.save();
      ctx.setLineDash([]);
      ctx.strokeStyle = color("paper");
      ctx.lineWidth = 3 * dpr;
      ctx.strokeText(text, x, y);
      ctx.restore();
      ctx.fillText(text, x, y);
    };
    // A label that would cover the previous one is moved down a line.
    const ends = [];
    for (const mark of [...raw.marks].sort((a, b) => a.at - b.at)) {
      const x = u.valToPos(mark.at, "x", true);
      line(x, bbox.top, x, bbox.top + bbox.height);
      const wide = ctx.measureText(mark.label).width + 5 * dpr;
      const flip = x + wide > bbox.left + bbox.width;
      const from = flip ? x - wide : x;
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      let row = ends.findIndex((end) => end <= from);
      if (row < 0) row = ends.length;
      label(mark.label, flip ? x - 4 * dpr : x + 4 * dpr, bbox.top + (3 + 14 * row) * dpr, flip ? "right" : "left");
      ends[row] = from + wide + 4 * dpr;
    }
    for (const band of raw.bands) {
      const x = 0.5 * (u.valToPos(band.from, "x", true) + u.valToPos(band.to, "x", true));
      label(band.label, x, bbox.top + bbox.height - 15 * dpr, "center");
    }
    for (const level of raw.levels) {
      const y = u.valToPos(level.at, "y", true);
      line(bbox.left, y, bbox.left + bbox.width, y);
      label(level.label, bbox.left + bbox.width - 5 * dpr, y - 14 * dpr, "right");
    }
    ctx.restore();
  }

  function build() {
    if (live.clientWidth === 0) return;
    if (!table) read();
    if (plot) {
      wanted = [plot.scales.x.min, plot.scales.x.max];
      plot.destroy();
    }
    quiet = true;
    plot = new uPlot(options(), table, box);
    const [min, max] = wanted || full;
    if (min < max) plot.setScale("x", { min, max });
    quiet = false;
    api.plot = plot;
    let down = null;
    plot.over.addEventListener("pointerdown", (event) => { down = event.clientX; });
    plot.over.addEventListener("click", (event) => {
      const still = down !== null && Math.abs(event.clientX - down) < 4;
      if (still && raw.timeline && page.player) {
        page.player.pause();
        page.player.seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
      }
    });
    place();
  }

  function scaleBy(factor) {
    const { min, max } = plot.scales.x;
    const warp = raw.x.log ? Math.log : (v) => v, back = raw.x.log ? Math.exp : (v) => v;
    const center = warp(cursor !== null && cursor > min && cursor < max ? cursor : back(0.5 * (warp(min) + warp(max))));
    const low = Math.max(warp(full[0]), center + (warp(min) - center) * factor);
    const high = Math.min(warp(full[1]), center + (warp(max) - center) * factor);
    if (high > low) plot.setScale("x", { min: back(low), max: back(high) });
  }

  function moveCursor(by) {
    const xs = table[0];
    if (raw.timeline && page.player) {
      const step = (plot.scales.x.max - plot.scales.x.min) / 200;
      page.player.pause();
      page.player.seek(page.player.time() + by * step);
      return;
    }
    const now = cursor === null ? 0 : nearest(xs, cursor);
    const to = Math.min(Math.max(now + by, 0), xs.length - 1);
    plot.setCursor({ left: plot.valToPos(xs[to], "x"), top: 20 });
  }

  reset.addEventListener("click", () => { plot.setScale("x", { min: full[0], max: full[1] }); box.focus(); });
  box.addEventListener("keydown", (event) => {
    if (!plot || event.ctrlKey || event.metaKey || event.altKey) return;
    const action = {
      ArrowLeft: () => moveCursor(event.shiftKey ? -10 : -1),
      ArrowRight: () => moveCursor(event.shiftKey ? 10 : 1),
      "+": () => scaleBy(0.5), "=": () => scaleBy(0.5), "-": () => scaleBy(2),
      0: () => plot.setScale("x", { min: full[0], max: full[1] }),
    }[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });

  const api = {
    timeline: raw.timeline, id: raw.id, zoom, build, plot: null, figure,
    series, title: raw.x.title, unit: raw.y.unit,
    onTime(time) {
      place();
      if (plot && plot.cursor.left < 0) readout(time);
    },
    range: () => (plot ? [plot.scales.x.min, plot.scales.x.max] : wanted || full),
  };
  return api;
}

// Formats a value of an axis with the precision of the picture; a value below one pixel is shown as
// zero.
function told(value, axis, scale, digits) {
  const span = scale ? scale.max - scale.min : 0;
  if (!isFinite(value) || axis.log || !(span > 0)) return withUnit(value, digits, axis.unit);
  const power = Math.floor(Math.log10(span / 500));
  const near = Number((Math.round(value / 10 ** power) * 10 ** power).toPrecision(12));
  const places = near === 0 ? 1 : Math.floor(Math.log10(Math.abs(near)) + 1e-9) - power + 1;
  return withUnit(near, Math.max(1, Math.min(digits, places)), axis.unit);
}

function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  if (tag === "svg") element.classList.add("bs");
  return element;
}

function plain(value, step) {
  const largest = Math.abs(value);
  if (largest !== 0 && (largest >= 1e6 || step < 1e-5)) return value.toExponential(1).replace("e+", "e").replace("-", "−");
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? (0).toFixed(decimals) : text).replace("-", "−");
}

function shortLog(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9);
  return exponent >= -3 && exponent <= 4 ? String(Number(value.toPrecision(3)))
    : value.toExponential(0).replace("e+", "e").replace("-", "−");
}
