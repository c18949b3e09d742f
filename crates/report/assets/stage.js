// The flat stage: bodies, paths, forces and events of one frame, drawn on a canvas.

const FOOT = 36; // space below the lowest body for the hatch of the ground and the scales (px)
const HATCH = 12; // distance between the strokes of the hatch (px)
const HEAD = 34; // space above the highest body for the clock and the announcements (px)
const ABOVE = 64; // the same with a callout that has no space beside the bodies

function bodyShape(body) {
  const trace = (line) => {
    const path = new Path2D();
    for (let k = 0; k + 1 < line.points.length; k += 2) {
      if (k === 0) path.moveTo(line.points[0], line.points[1]);
      else path.lineTo(line.points[k], line.points[k + 1]);
    }
    if (line.closed) path.closePath();
    return { path, closed: line.closed, points: line.points };
  };
  let reach = 0;
  for (const line of body.outlines) {
    for (let k = 0; k + 1 < line.points.length; k += 2) {
      reach = Math.max(reach, Math.hypot(line.points[k], line.points[k + 1]));
    }
  }
  return { outlines: body.outlines.map(trace), marks: body.marks.map(trace), reach };
}

function makeStage(data, canvas) {
  const shapes = data.bodies.map(bodyShape);
  const ground = data.bodies.findIndex((body) => body.role === "ground");
  const moving = data.bodies.map((body, at) => at).filter((at) => data.bodies[at].role !== "ground");
  const [left, bottom, right, top] = data.view;
  const stage = {
    // The names of many bodies would cover the picture.
    camera: "fixed", names: new Set(data.bodies.map((body) => body.name)).size <= 40, forces: false, traces: true, tint: false, ghosts: false,
    // Whether the callout of the moment is shown, and the position of the pointer (px).
    callout: false, hover: null, valued: null,
    head: HEAD,
    lens: { factor: 1, x: 0, z: 0 },
    // The largest scale (px/m) that may be used; panes side by side share one scale.
    most: Infinity,
    canvas, draw, resize, retheme, viewAt, scale,
    paint: () => paint,
    measures: () => ({ width, height, dpr }),
    // Whether the stage is drawn in three dimensions, which need more space than a narrow picture.
    deep: false,
    // The point of the canvas (px) about which the view zooms, and the size of the view (m).
    origin: () => [0.5 * width, height - FOOT],
    size: () => [right - left, top - bottom],
  };
  const place = {}, density = {};
  let paint = {};
  let width = 0, height = 0, dpr = 1;

  function retheme() {
    const names = ["paper", "ink", "soft", "rule", "grid", "ground", "barrel", "rack", "block",
      "device", "line", "accent", "s0", "s1", "s2", "s3", "s4", "s5"];
    paint = Object.fromEntries(names.map((name) => [name, color(name)]));
  }

  // `most` is the available height (px); a `full` screen uses all of it.
  function resize(most, full) {
    width = Math.max(120, Math.floor(canvas.parentElement.getBoundingClientRect().width));
    const own = (width * (top - bottom)) / (right - left) + FOOT + stage.head;
    const wanted = stage.deep ? Math.max(own, 0.8 * width) : own;
    height = Math.round(full ? most : Math.min(most, 640, Math.max(wanted, 220)));
    dpr = Math.min(window.devicePixelRatio || 1, 3);
    canvas.width = Math.round(width * dpr);
    canvas.height = Math.round(height * dpr);
    canvas.style.height = height + "px";
  }

  // Returns the scale (px/m) of the whole picture.
  function scale() {
    return Math.min(width / (right - left), (height - FOOT - stage.head) / (top - bottom), stage.most);
  }

  // Returns the view for a frame: the scale, and the world point at the middle of the lower edge of
  // the canvas.
  function viewAt(frame) {
    let x = 0.5 * (left + right), z = bottom;
    const pose = (body, k) => [data.poses[3 * body][k], data.poses[3 * body + 1][k]];
    if (stage.camera === "ground" && ground >= 0) {
      const [now, start] = [pose(ground, frame), pose(ground, 0)];
      if (isFinite(now[0] + now[1])) {
        x += now[0] - start[0];
        z += now[1] - start[1];
      }
    } else if (stage.camera === "stack" && moving.length > 0) {
      // The median stays with the stack when a single body leaves it.
      const shifts = moving.map((b) => pose(b, frame)[0] - pose(b, 0)[0]).filter(isFinite);
      shifts.sort((a, b) => a - b);
      if (shifts.length > 0) x += shifts[shifts.length >> 1];
      // A single body is followed down a slope too; bodies that fall off a stack are not followed.
      const fall = moving.length === 1 ? pose(moving[0], frame)[1] - pose(moving[0], 0)[1] : 0;
      if (isFinite(fall)) z += fall;
    }
    const { factor, x: aside, z: above } = stage.lens;
    return { scale: scale() * factor, x: x + aside, z: z + above };
  }

  function draw(frame, time) {
    const context = canvas.getContext("2d");
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.fillStyle = paint.paper;
    context.fillRect(0, 0, width, height);
    if (!(data.count > 0)) {
      context.fillStyle = paint.soft;
      context.font = "14px system-ui, sans-serif";
      context.fillText(t("no frames to show"), 16, 28);
      return;
    }
    const view = viewAt(frame);
    const toX = (x) => 0.5 * width + (x - view.x) * view.scale;
    const toY = (z) => height - FOOT - (z - view.z) * view.scale;
    const pen = { context, width, height, paint, frame, time, view, toX, toY };
    const at = groundAt(frame);
    if (stage.ghosts && data.ghosts) drawEnds(pen, data.ghosts, shapes, at, density);
    const tinted = stage.tint && data.tint;
    for (let body = 0; body < shapes.length; body++) drawBody(context, body, frame, view, toX, toY, tinted);
    drawTies(context, frame, time, toX, toY);
    if (stage.ghosts && data.ghosts) drawPaths(pen, data.ghosts, at);
    if (stage.ghosts && data.overlay) drawOverlay(pen, data.overlay);
    if (stage.traces) drawTraces(context, frame, toX, toY);
    // Names are drawn over arrows, and values only where there is no name.
    const arrows = stage.forces ? drawForces(pen, data, stage.strong) : [];
    const names = stage.names ? drawNames(context, frame, view, toX, toY, tinted) : [];
    drawEvents(pen);
    if (tinted) drawTintScale(pen, data.tint, stage.full);
    if (stage.callout && data.moment) drawMoment(pen);
    drawScales(pen);
    stage.valued = stage.hover ? drawForceValue(pen, arrows, stage.hover, names) : null;
  }

  // Returns the position of the ground (m).
  function groundAt(frame) {
    return ground < 0 ? [0, 0] : [data.poses[3 * ground][frame], data.poses[3 * ground + 1][frame]];
  }

  // Returns a body as [x, y, radius] (px).
  function circle(pen, body, frame) {
    const [x, z] = [data.poses[3 * body][frame], data.poses[3 * body + 1][frame]];
    return [pen.toX(x), pen.toY(z), shapes[body].reach * pen.view.scale];
  }

  function drawMoment(pen) {
    const { body, text, t } = data.moment;
    const at = circle(pen, body, pen.frame);
    if (!isFinite(at[0] + at[1])) return;
    ring(pen, body);
    // Bodies that move do so for about a second, so the place must be free before and after.
    const frames = [t - 0.5, t, t + 0.5, t + 1.1].map((time) => nearest(data.times, time));
    const circles = frames.flatMap((frame) => moving.map((one) => circle(pen, one, frame))).filter((one) => isFinite(one[0] + one[1]));
    drawCallout(pen, text, at, circles, place);
  }

  function drawBody(context, body, frame, view, toX, toY, tinted) {
    const [x, z, angle] = [0, 1, 2].map((c) => data.poses[3 * body + c][frame]);
    if (!isFinite(x + z + angle)) return;
    const role = data.bodies[body].role;
    const s = view.scale;
    context.save();
    context.translate(toX(x), toY(z));
    context.rotate(-angle);
    context.scale(s, -s);
    context.lineJoin = context.lineCap = "round";
    context.strokeStyle = role === "ground" ? paint.soft : paint.line;
    for (const { path, closed, points } of shapes[body].outlines) {
      context.lineWidth = (closed ? 1.2 : 2) / s;
      if (closed) {
        context.fillStyle = (tinted && tintOf(data, body, frame, stage.full, paint)) || paint[role];
        context.fill(path);
      }
      context.stroke(path);
      if (role === "ground" && !closed) drawHatch(context, points, s, view.x - x);
    }
    shapes[body].marks.forEach(({ path }, at) => {
      context.lineWidth = (role !== "ground" && at === 0 ? 3 : 0.9) / s;
      context.stroke(path);
    });
    context.restore();
  }

  // Draws straps until they tear.
  function drawTies(context, frame, time, toX, toY) {
    context.lineCap = "butt";
    for (const { bodies, points, torn } of data.ties) {
      if (torn !== null && time >= torn) continue;
      const [a, b] = bodies.map((body, end) => {
        const [x, z, angle] = [0, 1, 2].map((c) => data.poses[3 * body + c][frame]);
        const [px, pz] = points[end], cos = Math.cos(angle), sin = Math.sin(angle);
        return [toX(x + cos * px - sin * pz), toY(z + sin * px + cos * pz)];
      });
      if (!isFinite(a[0] + a[1] + b[0] + b[1])) continue;
      // A dark line under a light one is visible on wood, on steel and on paper.
      const line = (from, to, style, wide) => {
        context.beginPath();
        context.moveTo(a[0] + from * (b[0] - a[0]), a[1] + from * (b[1] - a[1]));
        context.lineTo(a[0] + to * (b[0] - a[0]), a[1] + to * (b[1] - a[1]));
        context.strokeStyle = style;
        context.lineWidth = wide;
        context.stroke();
      };
      line(0, 1, paint.line, 5);
      line(0, 1, paint.device, 3.2);
      // The buckle distinguishes a band from a rod.
      const half = 4 / Math.max(8, Math.hypot(b[0] - a[0], b[1] - a[1]));
      line(0.5 - half, 0.5 + half, paint.line, 8);
    }
  }

  // The strokes are at even positions in the frame of the ground, so that they move with it; only
  // visible ones are drawn.
  function drawHatch(context, points, s, middle) {
    const spacing = HATCH / s, reach = 0.5 * width / s + 2 * spacing;
    context.beginPath();
    for (let k = 0; k + 3 < points.length; k += 2) {
      const flip = points[k] > points[k + 2];
      const [ax, az, bx, bz] = flip ? [points[k + 2], points[k + 3], points[k], points[k + 1]] : points.slice(k, k + 4);
      const low = Math.max(ax, middle - reach), high = Math.min(bx, middle + reach);
      for (let x = Math.ceil(low / spacing) * spacing; x < high; x += spacing) {
        const z = az + ((bz - az) * (x - ax)) / (bx - ax);
        context.moveTo(x, z);
        context.lineTo(x - 0.7 * spacing, z - 0.7 * spacing);
      }
    }
    context.lineWidth = 0.9 / s;
    context.stroke();
  }

  // Draws the names and returns their boxes.
  function drawNames(context, frame, view, toX, toY, tinted) {
    const boxes = [];
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (const body of moving) {
      const [x, z] = [data.poses[3 * body][frame], data.poses[3 * body + 1][frame]];
      const { name, role } = data.bodies[body];
      const size = Math.min(13, 0.62 * shapes[body].reach * view.scale);
      if (!isFinite(x + z) || role === "rack" || size < 8) continue;
      context.font = `600 ${size}px system-ui, sans-serif`;
      // Below the center, where paths start and run.
      const y = toY(z) + (stage.traces && data.traces.length > 0 ? 1.15 * size : 0);
      context.lineWidth = 3;
      context.lineJoin = "round";
      context.strokeStyle = tinted ? paint.paper : paint[role];
      context.strokeText(name, toX(x), y);
      context.fillStyle = paint.line;
      context.fillText(name, toX(x), y);
      const half = 0.5 * context.measureText(name).width + 2;
      boxes.push([toX(x) - half, y - 0.6 * size, toX(x) + half, y + 0.6 * size]);
    }
    return boxes;
  }

  function drawTraces(context, frame, toX, toY) {
    data.traces.forEach((trace, at) => {
      const [xs, zs, angles] = [0, 1, 2].map((c) => data.poses[3 * trace.body + c]);
      const [px, pz] = trace.point;
      // If the camera follows the ground, the path is relative to the ground.
      const onGround = stage.camera === "ground" && ground >= 0;
      const gx = onGround ? data.poses[3 * ground] : null, gz = onGround ? data.poses[3 * ground + 1] : null;
      context.beginPath();
      let pen = false, x = 0, y = 0;
      for (let k = 0; k <= frame; k++) {
        const cos = Math.cos(angles[k]), sin = Math.sin(angles[k]);
        const wx = xs[k] + cos * px - sin * pz + (gx ? gx[frame] - gx[k] : 0);
        const wz = zs[k] + sin * px + cos * pz + (gz ? gz[frame] - gz[k] : 0);
        if (!isFinite(wx + wz)) {
          pen = false;
          continue;
        }
        x = toX(wx);
        y = toY(wz);
        if (pen) context.lineTo(x, y);
        else context.moveTo(x, y);
        pen = true;
      }
      context.strokeStyle = paint["s" + (at % 6)];
      context.setLineDash(data.dashes[at % 6].split(" ").filter(Boolean).map(Number));
      context.lineWidth = 1.6;
      context.stroke();
      context.setLineDash([]);
      if (pen) {
        context.beginPath();
        context.arc(x, y, 3.2, 0, 7);
        context.fillStyle = paint["s" + (at % 6)];
        context.fill();
      }
    });
  }

  // Marks a body by its outline.
  function ring({ context, frame, view, toX, toY }, body) {
    const [x, z, angle] = [0, 1, 2].map((c) => data.poses[3 * body + c][frame]);
    if (!isFinite(x + z + angle)) return;
    context.save();
    context.translate(toX(x), toY(z));
    context.rotate(-angle);
    context.scale(view.scale, -view.scale);
    context.strokeStyle = paint.accent;
    context.lineJoin = "round";
    context.lineWidth = 3.5 / view.scale;
    for (const { path } of shapes[body].outlines) context.stroke(path);
    context.restore();
  }

  function drawEvents(pen) {
    for (const { body } of currentEvents(data, pen.time)) {
      if (body !== null && data.bodies[body].role !== "ground") ring(pen, body);
    }
  }

  function drawScales(pen) {
    const { context, view } = pen;
    const bar = roundLength(0.18 * width / view.scale);
    const length = bar * view.scale, y = height - 12;
    context.strokeStyle = context.fillStyle = paint.ink;
    context.lineWidth = 1.4;
    context.beginPath();
    context.moveTo(14, y - 4);
    context.lineTo(14, y);
    context.lineTo(14 + length, y);
    context.lineTo(14 + length, y - 4);
    context.stroke();
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    halo(pen, bar >= 1 ? `${bar}\u00a0m` : `${readable(bar * 100, 1)}\u00a0cm`, 20 + length, y - 2);
  }

  // If everything leaves the picture, the camera follows.
  const end = data.count - 1;
  const inside = (b) => {
    const [x, z] = [data.poses[3 * b][end], data.poses[3 * b + 1][end]];
    return x > left && x < right && z > bottom && z < top;
  };
  if (end > 0 && moving.length > 0 && !moving.some(inside)) stage.camera = "stack";
  return stage;
}

// Returns the events within the last 0.8 s of the run.
function currentEvents(data, time) {
  return data.events.filter((event) => event.t <= time + 1e-6 && event.t > time - 0.8);
}
