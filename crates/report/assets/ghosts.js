// Other runs drawn over the run that is shown: paths of the top barrels, final positions, or
// another run at the same time.

const MOST_INK = 0.85; // opacity where every run has a body
const AROUND = 60; // margin (px) of the picture of final positions, because it moves with the ground

// Draws the paths of all runs, relative to the ground.
function drawPaths({ context, toX, toY, paint }, { paths: [xs, zs] }, [gx, gz]) {
  context.beginPath();
  let pen = false;
  for (let k = 0; k < xs.length; k++) {
    if (!isFinite(xs[k])) pen = false;
    else {
      if (pen) context.lineTo(toX(gx + xs[k]), toY(gz + zs[k]));
      else context.moveTo(toX(gx + xs[k]), toY(gz + zs[k]));
      pen = true;
    }
  }
  context.strokeStyle = paint.s0;
  context.globalAlpha = 0.4;
  context.lineWidth = 0.8;
  context.lineJoin = "round";
  context.stroke();
  context.globalAlpha = 1;
}

// Draws the final positions: the darker a spot, the larger the share of runs with a body there.
// The picture is drawn once per view.
function drawEnds(pen, ghosts, shapes, at, cache) {
  const { context, width, height, view, paint } = pen;
  const key = [width, height, view.scale, view.x, view.z, paint.accent].join();
  if (cache.key !== key) {
    cache.key = key;
    cache.picture = sumOfEnds(pen, ghosts, shapes);
  }
  context.globalAlpha = MOST_INK;
  const [x, y] = [at[0] * view.scale - AROUND, -at[1] * view.scale - AROUND];
  context.drawImage(cache.picture, x, y, width + 2 * AROUND, height + 2 * AROUND);
  context.globalAlpha = 1;
}

function sumOfEnds({ width, height, view, toX, toY, paint }, { count, bodies, ends: [xs, zs, angles] }, shapes) {
  const picture = document.createElement("canvas");
  const dpr = Math.min(window.devicePixelRatio || 1, 3);
  [picture.width, picture.height] = [width, height].map((side) => Math.round((side + 2 * AROUND) * dpr));
  const context = picture.getContext("2d");
  // Opacities add up over all runs.
  context.globalCompositeOperation = "lighter";
  context.globalAlpha = 1 / Math.max(count, 1);
  bodies.forEach((body, k) => {
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.translate(toX(xs[k]) + AROUND, toY(zs[k]) + AROUND);
    context.rotate(-angles[k]);
    context.scale(view.scale, -view.scale);
    for (const { path, closed } of shapes[body].outlines) if (closed) context.fill(path);
  });
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.globalCompositeOperation = "source-in";
  context.globalAlpha = 1;
  context.fillStyle = paint.s0;
  context.fillRect(0, 0, picture.width, picture.height);
  return picture;
}

// Draws the outlines of the bodies of another run at the same time.
function drawOverlay({ context, time, view, toX, toY, paint }, other) {
  const frame = nearest(other.times, time);
  other.shapes ??= other.bodies.map(bodyShape);
  context.strokeStyle = paint.s0;
  context.setLineDash([5, 3].map((length) => length / view.scale));
  other.bodies.forEach(({ role }, body) => {
    const [x, z, angle] = [0, 1, 2].map((c) => other.poses[3 * body + c][frame]);
    if (role === "ground" || !isFinite(x + z + angle)) return;
    context.save();
    context.translate(toX(x), toY(z));
    context.rotate(-angle);
    context.scale(view.scale, -view.scale);
    context.lineWidth = 1.6 / view.scale;
    for (const { path } of other.shapes[body].outlines) context.stroke(path);
    context.restore();
  });
  context.setLineDash([]);
}
