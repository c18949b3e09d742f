// The stage in three dimensions: barrels, racks and floor of one frame, drawn with WebGL into the
// canvas of the flat stage.

const FLOOR = 60; // extent of the floor around the bodies (m)
const SAMPLES = 240; // number of frames from which the extent of the bodies is sampled
const SINCE = 3; // time (s) for which the picture keeps showing where bodies have been
const AHEAD = 0.5; // time (s) over which the picture widens for bodies that leave it
const SHARPEST = 2; // maximum number of picture pixels per page pixel
const SLOW_FRAME = 45, PATIENCE = 12; // duration (ms) of a slow picture, and the number of slow pictures in a row before quality is reduced

// Directions in space, in steps of an eighth turn.
const SIDES = [-1, 0, 1].flatMap((x) => [-1, 0, 1].flatMap((y) => [-1, 0, 1].map((z) => [x, y, z]))).filter((side) => side.some(Boolean));

// The renderer that all stages share, with its materials.
function makeEngine(three, canvas, context) {
  const renderer = new three.WebGLRenderer({ canvas, context, alpha: true, antialias: true });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = three.PCFShadowMap;
  renderer.setClearColor(0, 0);
  const picture = (image) => {
    const texture = new three.CanvasTexture(image);
    texture.colorSpace = three.SRGBColorSpace;
    texture.wrapS = texture.wrapT = three.RepeatWrapping;
    texture.anisotropy = 4;
    return texture;
  };
  const standard = (roughness, metalness, map) => new three.MeshStandardMaterial({ roughness, metalness, map: map ?? null });
  const materials = {
    wood: standard(0.72, 0, picture(woodPicture(24, false, 1024, 256))),
    head: standard(0.78, 0, picture(woodPicture(7, true, 512, 512))),
    steel: standard(0.5, 0.2), rack: standard(0.45, 0.1), device: standard(0.6, 0), block: standard(0.7, 0), ground: standard(0.8, 0),
    band: standard(0.7, 0),
    floor: new three.MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
    grid: new three.LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
    shadow: new three.ShadowMaterial({ depthWrite: false }),
  };
  const names = new Map();
  // Returns the texture of the name of a barrel, as painted on its heads.
  function nameOf(text, ink) {
    const key = `${ink} ${text}`;
    if (!names.has(key)) {
      const image = make("canvas", { width: 256, height: 128 });
      const pen = image.getContext("2d");
      pen.font = `800 ${text.length > 5 ? 66 : 92}px system-ui, sans-serif`;
      pen.textAlign = "center";
      pen.textBaseline = "middle";
      pen.fillStyle = ink;
      pen.fillText(text, 128, 68, 244);
      names.set(key, new three.MeshBasicMaterial({ map: picture(image), transparent: true, opacity: 0.9, depthWrite: false }));
    }
    return names.get(key);
  }
  function retheme(paint) {
    for (const name of ["rack", "device", "block", "ground"]) materials[name].color.set(paint[name]);
    materials.band.color.set(paint.device);
    materials.wood.color.set(paint.barrel);
    materials.head.color.set(paint.barrel).multiplyScalar(1.2);
    materials.steel.color.set(paint.rack).multiplyScalar(0.45);
    materials.floor.color.set(paint.ground);
    materials.grid.color.set(paint.soft);
    materials.shadow.opacity = isDark(paint) ? 0.5 : 0.28;
  }
  // Without a graphics card pictures are slow: shadows are dropped first, then sharpness.
  const pace = { slow: 0, plainness: 0 };
  function timed(duration) {
    pace.slow = duration > SLOW_FRAME ? pace.slow + 1 : 0;
    if (pace.slow < PATIENCE || pace.plainness === 2) return;
    pace.plainness += 1;
    pace.slow = 0;
  }
  const onLost = (listener) => canvas.addEventListener("webglcontextlost", listener);
  return { three, renderer, materials, nameOf, retheme, pace, timed, onLost };
}

const isDark = (paint) => parseInt(paint.paper.slice(1, 3), 16) < 128;

// `flat` is the flat stage whose canvas and options this stage shares; `eye` is the camera of all
// `stages`.
function makeDeepStage(data, flat, engine, eye, stages) {
  const { three, renderer, materials } = engine, { depth } = data, { canvas } = flat;
  const scene = new three.Scene(), camera = new three.PerspectiveCamera();
  const moving = depth.bodies.map((_, body) => body).filter((body) => depth.bodies[body].role !== "ground");
  const ground = depth.bodies.findIndex(({ role }) => role === "ground");
  const stage = { draw, retheme, room, perPixel: () => 0, bodyAt, project, placeOf, pushesAt };
  const place = {}, now = depth.bodies.map(() => new three.Matrix4());
  const unseen = new three.Matrix4().makeScale(0, 0, 0);
  const [matrix, quaternion, vector, one] = [new three.Matrix4(), new three.Quaternion(), new three.Vector3(), new three.Vector3(1, 1, 1)];
  let paint = {}, width = 0, height = 0, target = [0, 0, 0], away = 1, back = [0, -1, 0];

  // Returns the pose of a body as position and quaternion; null if unknown.
  function poseOf(body, frame) {
    if (!depth.plane) {
      const [x, y, z, w, a, b, c] = [0, 1, 2, 3, 4, 5, 6].map((k) => depth.poses[7 * body + k][frame]);
      return isFinite(x + y + z + w + a + b + c) ? [x, y, z, a, b, c, w] : null;
    }
    const [u, z, angle] = [0, 1, 2].map((k) => data.poses[3 * body + k][frame]);
    if (!isFinite(u + z + angle)) return null;
    const [sin, cos] = [Math.sin(0.5 * angle), Math.cos(0.5 * angle)];
    return depth.plane === "across" ? [u, 0, z, 0, -sin, 0, cos] : [0, u, z, sin, 0, 0, cos];
  }
  function pose(body, frame, into) {
    const known = poseOf(body, frame);
    if (!known) return false;
    into.compose(vector.set(...known.slice(0, 3)), quaternion.set(...known.slice(3)).normalize(), one);
    return true;
  }

  // Bodies with the same shape and material are drawn in one call.
  const geometries = depth.shapes.map(() => new Map());
  const groups = [], labels = [], corners = [];
  function geometryOf({ places, normals, maps, faces }) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(places, 3));
    geometry.setAttribute("normal", new three.Float32BufferAttribute(normals, 3));
    geometry.setAttribute("uv", new three.Float32BufferAttribute(maps, 2));
    geometry.setIndex(faces);
    return geometry;
  }
  depth.bodies.forEach(({ shape, role }, body) => {
    const known = geometries[shape];
    if (!known.has(role)) {
      const meshes = meshesOf(depth.shapes[shape], role);
      const box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
      for (const { places } of Object.values(meshes)) {
        places.forEach((value, k) => {
          box[0][k % 3] = Math.min(box[0][k % 3], value);
          box[1][k % 3] = Math.max(box[1][k % 3], value);
        });
      }
      const parts = Object.entries(meshes).filter(([name]) => name !== "label")
        .map(([name, mesh]) => ({ name, geometry: geometryOf(mesh), bodies: [] }));
      known.set(role, { parts, box, label: meshes.label && geometryOf(meshes.label) });
    }
    const { parts, box } = known.get(role);
    for (const { bodies } of parts) bodies.push(body);
    corners[body] = parts.length > 0
      ? Array.from({ length: 8 }, (_, k) => [0, 1, 2].map((axis) => box[(k >> axis) & 1][axis])) : [];
  });
  for (const kinds of geometries) {
    for (const { parts, label } of kinds.values()) {
      for (const { name, geometry, bodies } of parts) {
        const places = bodies.flatMap((body) => depth.bodies[body].rows.map((row) => ({ body, row })));
        const mesh = new three.InstancedMesh(geometry, materials[name], places.length);
        mesh.frustumCulled = false;
        mesh.castShadow = mesh.receiveShadow = true;
        const white = new three.Color(1, 1, 1);
        if (name === "wood" || name === "head") places.forEach((_, k) => mesh.setColorAt(k, white));
        groups.push({ mesh, name, places });
        scene.add(mesh);
        if (name !== "head" || !label || places.length > 120) continue;
        for (const at of places) {
          const mark = new three.Mesh(label, materials.head);
          mark.matrixAutoUpdate = false;
          labels.push({ mark, ...at });
          scene.add(mark);
        }
      }
    }
  }
  const bands = new three.InstancedMesh(new three.BufferGeometry(), materials.band, Math.max(1, depth.ties.length));
  {
    const mesh = makeMesh();
    addBlock(mesh, [0.5, 0, 0], [[0.5, 0, 0], [0, 0.02, 0], [0, 0, 0.008]]);
    bands.geometry = geometryOf(mesh);
    bands.frustumCulled = false;
    bands.castShadow = true;
    scene.add(bands);
  }

  const sky = new three.HemisphereLight(0xffffff, 0xb0a79c, 1.5), sun = new three.DirectionalLight(0xfff4e2, 2.1);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.bias = -4e-4;
  sun.shadow.normalBias = 0.02;
  sun.shadow.radius = 5;
  scene.add(sky, sun, sun.target);

  // The floor fades into the paper; its one-meter grid moves with the ground.
  const floor = new three.Group(), field = new three.Group();
  {
    const rings = [0, 0.08, 0.2, 0.45, 1], sides = 64, places = [], colors = [], faces = [];
    rings.forEach((share, ring) => {
      for (let side = 0; side < sides; side++) {
        const angle = (2 * Math.PI * side) / sides;
        places.push(share * FLOOR * Math.cos(angle), share * FLOOR * Math.sin(angle), 0);
        colors.push(1, 1, 1, 0.5 * (1 - share) ** 3);
        if (ring === 0) continue;
        const [a, b] = [(ring - 1) * sides + side, (ring - 1) * sides + ((side + 1) % sides)];
        faces.push(a, a + sides, b, b, a + sides, b + sides);
      }
    });
    const disc = new three.BufferGeometry();
    disc.setAttribute("position", new three.Float32BufferAttribute(places, 3));
    disc.setAttribute("normal", new three.Float32BufferAttribute(places.map((_, k) => (k % 3 === 2 ? 1 : 0)), 3));
    disc.setAttribute("color", new three.Float32BufferAttribute(colors, 4));
    disc.setIndex(faces);
    const plane = new three.Mesh(disc, materials.floor), shade = new three.Mesh(disc, materials.shadow);
    shade.receiveShadow = true;
    const [lines, tones] = [[], []], half = 24;
    for (let k = -half; k <= half; k++) {
      for (let step = -half; step < half; step++) {
        for (const [x, y] of [[k, step], [k, step + 1], [step, k], [step + 1, k]]) {
          lines.push(x, y, 0);
          tones.push(1, 1, 1, 0.38 * Math.max(0, 1 - Math.hypot(x, y) / half) ** 2);
        }
      }
    }
    const grid = new three.BufferGeometry();
    grid.setAttribute("position", new three.Float32BufferAttribute(lines, 3));
    grid.setAttribute("color", new three.Float32BufferAttribute(tones, 4));
    const net = new three.LineSegments(grid, materials.grid);
    [plane.renderOrder, shade.renderOrder, net.renderOrder] = [-3, -2, -1];
    for (const one of [plane, shade, net]) one.position.z = -0.004;
    field.add(plane, shade, net);
    floor.add(field);
    floor.matrixAutoUpdate = false;
    scene.add(floor);
  }

  // Returns the displacement (m) of the camera that follows the ground or the stack.
  function shiftAt(frame) {
    const shift = (body) => {
      const [was, is] = [poseOf(body, 0), poseOf(body, frame)];
      return was && is ? [0, 1, 2].map((axis) => is[axis] - was[axis]) : [0, 0, 0];
    };
    if (flat.camera === "ground" && ground >= 0) return shift(ground);
    if (flat.camera !== "stack" || moving.length === 0) return [0, 0, 0];
    const all = moving.map(shift);
    const middle = (axis) => all.map((one) => one[axis]).sort((a, b) => a - b)[all.length >> 1];
    return [middle(0), middle(1), moving.length === 1 ? all[0][2] : 0];
  }

  // For sampled times, the farthest points of the bodies in all directions, relative to the camera.
  // They spread ahead of time, before the bodies reach the edge of the picture. If paths are shown,
  // the points cover the time since the start.
  const rooms = {};
  function known(back) {
    const stride = Math.max(1, Math.ceil(data.count / SAMPLES)), times = [], alone = [];
    for (let frame = 0; frame < data.count; frame += stride) {
      const shift = shiftAt(frame), far = SIDES.map(() => -Infinity), points = SIDES.map(() => [0, 0, 0]);
      for (const body of moving) {
        if (corners[body].length === 0 || !pose(body, frame, matrix)) continue;
        for (const corner of corners[body]) {
          vector.set(...corner).applyMatrix4(matrix);
          for (const row of depth.bodies[body].rows) {
            const point = [vector.x + row[0] - shift[0], vector.y + row[1] - shift[1], vector.z + row[2] - shift[2]];
            SIDES.forEach((side, k) => {
              const along = dot(side, point);
              if (along > far[k]) [far[k], points[k]] = [along, point];
            });
          }
        }
      }
      if (!isFinite(far[0])) continue;
      times.push(data.times[frame]);
      alone.push({ far, points });
    }
    if (times.length === 0) return { times: [0], lists: [SIDES.flat()] };
    let first = 0;
    const lists = times.map((time, at) => {
      while (times[first] < time - back) first += 1;
      return SIDES.flatMap((_, k) => {
        let best = alone[first];
        for (let one = first; one <= at; one++) if (alone[one].far[k] > best.far[k]) best = alone[one];
        return best.points[k];
      });
    });
    return { times, lists };
  }
  function room(time) {
    const back = flat.traces && data.traces.length > 0 ? Infinity : SINCE;
    const { times, lists } = (rooms[`${flat.camera} ${back}`] ??= known(back));
    if (times.length === 1) return threes(lists[0]);
    const sum = lists[0].map(() => 0), steps = 14;
    for (let k = 0; k < steps; k++) {
      const at = Math.min(Math.max(time + AHEAD * ((2 * k) / (steps - 1) - 0.5), times[0]), times.at(-1));
      const next = Math.max(times.findIndex((t) => t >= at), 1);
      const share = (at - times[next - 1]) / (times[next] - times[next - 1] || 1);
      for (let c = 0; c < sum.length; c++) sum[c] += (lists[next - 1][c] + share * (lists[next][c] - lists[next - 1][c])) / steps;
    }
    return threes(sum);
  }

  // Places the camera where it sees the points of all stages.
  function aim(time, shift) {
    const list = stages().flatMap((one) => one.room(time));
    const [low, high] = [Math.min, Math.max].map((end) => [0, 1, 2].map((axis) => end(...list.map((point) => point[axis]))));
    let middle = low.map((value, axis) => 0.5 * (value + high[axis]));
    const center = plus(middle, shift), axes = eye.axes(), tan = Math.tan(0.5 * LENS), aspect = width / height;
    const [above, below] = [flat.head + 8, 34];
    const [tanX, tanY] = [(tan * aspect * (width - 28)) / width, (tan * (height - above - below)) / height];
    // Nearer points look larger, so the center of the picture is found by iteration.
    for (let round = 0; round < 4; round++) {
      const inView = list.map((corner) => {
        const offset = plus(corner, middle, -1);
        return [dot(offset, axes.right), dot(offset, axes.up), dot(offset, axes.back)];
      });
      away = Math.max(0.2, ...inView.map(([x, y, toward]) => Math.max(Math.abs(x) / tanX, Math.abs(y) / tanY) + toward));
      for (const [axis, way] of [axes.right, axes.up].entries()) {
        const ends = inView.map((one) => one[axis] / (away - one[2]));
        middle = plus(middle, way, 0.5 * away * (Math.min(...ends) + Math.max(...ends)));
      }
    }
    middle = plus(middle, axes.up, (away * tan * (above - below)) / height);
    away /= eye.factor;
    target = plus(plus(middle, shift), eye.aside);
    back = axes.back;
    const [r, u, b] = [axes.right, axes.up, axes.back], p = plus(target, b, away);
    camera.fov = (LENS * 180) / Math.PI;
    camera.aspect = aspect;
    camera.near = 0.02 * away;
    camera.far = away + 3 * FLOOR;
    camera.updateProjectionMatrix();
    camera.matrixAutoUpdate = false;
    camera.matrix.set(r[0], u[0], b[0], p[0], r[1], u[1], b[1], p[1], r[2], u[2], b[2], p[2], 0, 0, 0, 1);
    camera.matrixWorldNeedsUpdate = true;
    camera.updateMatrixWorld(true);
    stage.perPixel = () => (2 * away * tan) / height;
    // The sun is to the left of the camera, so that the visible side is lit from every viewpoint.
    const size = 0.5 * Math.hypot(...high.map((value, axis) => value - low[axis])) + 0.3;
    const around = eye.around - 0.7, from = [0.75 * Math.sin(around), -0.75 * Math.cos(around), 1.15];
    sun.position.set(...plus(center, from, 2 * size));
    sun.target.position.set(...center);
    Object.assign(sun.shadow.camera, { left: -size, right: size, bottom: -size, top: size, near: 0.1, far: 5 * size });
    sun.shadow.camera.updateProjectionMatrix();
  }

  // Projects a point (m) onto the page: its position (px), and the scale (px/m) there.
  function project(point) {
    const offset = plus(plus(point, target, -1), back, -away), { right, up } = eye.axes();
    const far = -dot(offset, back), scale = height / (2 * Math.tan(0.5 * LENS) * far);
    return far > 0 ? [0.5 * width + scale * dot(offset, right), 0.5 * height - scale * dot(offset, up), scale] : [NaN, NaN, 0];
  }

  function update(frame, time) {
    const placed = depth.bodies.map((_, body) => pose(body, frame, now[body]));
    const base = new three.Color(), tinted = flat.tint && data.tint && depth.plane;
    for (const { mesh, name, places } of groups) {
      places.forEach(({ body, row }, k) => {
        if (!placed[body]) return mesh.setMatrixAt(k, unseen);
        matrix.makeTranslation(...row).multiply(now[body]);
        mesh.setMatrixAt(k, matrix);
        if (!mesh.instanceColor) return;
        const tone = tinted && tintOf(data, body, frame, flat.full, paint);
        // The color replaces that of the material, by which it is multiplied.
        if (tone) base.setRGB(...tone.match(/[\d.]+/g).map((part) => part / 255), three.SRGBColorSpace);
        const own = mesh.material.color;
        mesh.setColorAt(k, tone ? base.setRGB(base.r / own.r, base.g / own.g, base.b / own.b) : base.setRGB(1, 1, 1));
      });
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
      mesh.boundingSphere = null;
    }
    for (const { mark, body, row } of labels) {
      mark.visible = flat.names && placed[body];
      if (!mark.visible) continue;
      mark.matrix.makeTranslation(...row).multiply(now[body]);
      mark.matrixWorldNeedsUpdate = true;
      mark.material = engine.nameOf(depth.bodies[body].name, paint.line);
    }
    depth.ties.forEach(({ bodies, points, torn }, k) => {
      const [a, b] = bodies.map((body, end) => new three.Vector3(...points[end]).applyMatrix4(now[body]));
      const gone = (torn !== null && time >= torn) || !bodies.every((body) => placed[body]);
      const along = b.sub(a), length = along.length();
      quaternion.setFromUnitVectors(vector.set(1, 0, 0), along.clone().normalize());
      bands.setMatrixAt(k, gone ? unseen : matrix.compose(a, quaternion, vector.set(length, 1, 1)));
    });
    if (depth.ties.length === 0) bands.setMatrixAt(0, unseen);
    bands.instanceMatrix.needsUpdate = true;
    if (ground >= 0 && placed[ground]) floor.matrix.copy(now[ground]);
    floor.matrixWorldNeedsUpdate = true;
    const at = ground >= 0 ? [now[ground].elements[12], now[ground].elements[13]] : [0, 0];
    field.position.set(Math.round(target[0] - at[0]), Math.round(target[1] - at[1]), 0);
  }

  function retheme() {
    paint = flat.paint();
    engine.retheme(paint);
    sky.groundColor.set(isDark(paint) ? 0x4a4540 : 0xb0a79c);
    sky.intensity = isDark(paint) ? 2.0 : 2.3;
    sun.intensity = isDark(paint) ? 2.9 : 2.6;
  }

  function draw(frame, time) {
    let dpr;
    ({ width, height, dpr } = flat.measures());
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = paint.paper;
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!(data.count > 0)) return;
    aim(time, shiftAt(frame));
    update(frame, time);
    const since = performance.now(), { plainness } = engine.pace;
    sun.castShadow = plainness === 0;
    const share = Math.min(1, SHARPEST / dpr) * (plainness === 2 ? 0.6 : 1), picture = renderer.domElement;
    const [wide, high] = [canvas.width, canvas.height].map((side) => Math.round(share * side));
    if (picture.width !== wide || picture.height !== high) renderer.setSize(wide, high, false);
    renderer.render(scene, camera);
    context.drawImage(picture, 0, 0, canvas.width, canvas.height);
    engine.timed(performance.now() - since);
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    const view = { scale: [eye.around, eye.above, eye.factor, ...eye.aside].map((v) => v.toFixed(2)).join() };
    drawOver({ context, width, height, paint, frame, time, view });
  }

  // Returns the position (px) of a body and the radius of its picture.
  function circle(body, frame) {
    const [x, y, scale] = project(placeOf(body, frame));
    const reach = Math.max(0, ...corners[body].map((corner) => Math.hypot(...corner)));
    return [x, y, 0.72 * reach * scale];
  }

  // Returns the center (m) of the copy of a body that is nearest to the camera.
  function placeOf(body, frame) {
    const rows = depth.bodies[body].rows, at = poseOf(body, frame) ?? [NaN, NaN, NaN];
    return plus(at, rows.reduce((best, row) => (dot(row, back) > dot(best, back) ? row : best), rows[0]));
  }

  // Draws labels, arrows and paths over the picture.
  function drawOver(pen) {
    const { context } = pen;
    if (flat.traces) drawPaths(pen);
    const arrows = flat.forces ? drawPushes(pen) : [];
    for (const { body } of currentEvents(depth, pen.time)) {
      if (body !== null && depth.bodies[body].role !== "ground") ring(pen, circle(body, pen.frame));
    }
    if (flat.tint && data.tint && depth.plane) drawTintScale(pen, data.tint, flat.full);
    if (flat.callout && depth.moment) {
      const at = circle(depth.moment.body, pen.frame);
      if (isFinite(at[0])) {
        ring(pen, at);
        drawCallout(pen, depth.moment.text, at, moving.filter((body) => corners[body].length > 0).map((body) => circle(body, pen.frame)), place);
      }
    }
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.fillStyle = paint.soft;
    context.textAlign = "left";
    const grid = t("grid of {1}", "1\u00a0m");
    halo(pen, grid, 14, height - 14);
    // A plane models one barrel of a row.
    const alike = t("all barrels of a row move alike");
    if (depth.bodies.some(({ rows }) => rows.length > 1) && context.measureText(alike).width < width - 28) halo(pen, alike, 14, height - 31);
    if (!eye.turned && stages()[0] === stage) {
      context.textAlign = "right";
      const room = width - 48 - context.measureText(grid).width;
      const hints = [t("drag to turn, two fingers or Ctrl and wheel to zoom"), t("drag to turn")];
      const hint = hints.find((one) => context.measureText(one).width < room);
      if (hint) halo(pen, hint, width - 14, height - 14);
    }
    flat.valued = flat.hover ? drawForceValue(pen, arrows, flat.hover, []) : null;
    if (flat.hover && !flat.valued) drawLabel(pen, flat.hover);
  }

  function ring({ context }, [x, y, radius]) {
    context.strokeStyle = paint.accent;
    context.lineWidth = 3;
    context.beginPath();
    context.arc(x, y, radius, 0, 7);
    context.stroke();
  }

  const inPlane = (u, z) => (depth.plane === "across" ? [u, 0, z] : [0, u, z]);

  function drawPaths({ context, frame }) {
    data.traces.forEach((trace, at) => {
      const [px, pz] = trace.point, [xs, zs, angles] = [0, 1, 2].map((c) => data.poses[3 * trace.body + c]);
      // In space a path is that of a body's center, if the body exists.
      if (!depth.plane && !depth.bodies[depth.paths[at]]) return;
      const center = depth.plane ? null : [0, 1, 2].map((c) => depth.poses[7 * depth.paths[at] + c]);
      context.beginPath();
      let open = false;
      for (let k = 0; k <= frame; k++) {
        const [cos, sin] = center ? [1, 0] : [Math.cos(angles[k]), Math.sin(angles[k])];
        const point = center ? center.map((values) => values[k]) : inPlane(xs[k] + cos * px - sin * pz, zs[k] + sin * px + cos * pz);
        const [x, y] = project(point);
        if (isFinite(x + y)) context[open ? "lineTo" : "moveTo"](x, y);
        open = isFinite(x + y);
      }
      context.strokeStyle = paint["s" + (at % 6)];
      context.setLineDash(data.dashes[at % 6].split(" ").filter(Boolean).map(Number));
      context.lineWidth = 1.6;
      context.stroke();
      context.setLineDash([]);
    });
  }

  // Returns the contact forces of a frame, each with its point (m) and its components (N).
  function pushesAt(frame) {
    if (depth.plane) return forcesAt(data, frame).map(({ x, z, fx, fz }) => ({ at: inPlane(x, z), force: inPlane(fx, fz) }));
    const { at, force } = depth.forces ?? { at: [[]], force: [] };
    const list = at[0].map((_, slot) => ({ at: at.map((axis) => axis[slot][frame]), force: force.map((axis) => axis[slot][frame]) }));
    return list.filter((one) => isFinite([...one.at, ...one.force].reduce((sum, value) => sum + value)));
  }

  function drawPushes({ context, frame }) {
    const perNewton = flat.strong > 0 ? (FORCE_SHARE * height * stage.perPixel()) / flat.strong : 0;
    context.strokeStyle = context.fillStyle = paint.s1;
    context.lineWidth = 2;
    context.lineCap = "butt";
    const arrows = pushesAt(frame).map(({ at, force }) => {
      const [x, y] = project(at);
      const [tipX, tipY] = project(plus(at, force, perNewton));
      return { x, y, tipX, tipY, size: Math.hypot(...force) };
    });
    for (const one of arrows) arrow(context, one.x, one.y, one.tipX, one.tipY);
    return arrows;
  }

  // Returns the body at a position of the stage (px); null if there is none.
  const rays = new three.Raycaster();
  function bodyAt([x, y]) {
    rays.setFromCamera({ x: (2 * x) / width - 1, y: 1 - (2 * y) / height }, camera);
    const [hit] = rays.intersectObjects(groups.map(({ mesh }) => mesh), false);
    return hit ? groups.find(({ mesh }) => mesh === hit.object).places[hit.instanceId].body : null;
  }

  function drawLabel(pen, at) {
    const body = bodyAt(at);
    if (body === null || !depth.bodies[body].name) return;
    const { context } = pen, { name, role } = depth.bodies[body];
    const text = role === "barrel" ? t("barrel {1}", name) : role === "rack" ? t("rack {1}", name) : name;
    context.font = "600 13px system-ui, sans-serif";
    const wide = context.measureText(text).width + 16;
    const [x, y] = [Math.min(Math.max(at[0] - 0.5 * wide, 4), width - wide - 4), Math.max(at[1] - 36, 4)];
    context.fillStyle = paint.paper;
    context.strokeStyle = paint.soft;
    context.lineWidth = 1;
    context.beginPath();
    context.roundRect(x, y, wide, 24, 5);
    context.fill();
    context.stroke();
    context.fillStyle = paint.ink;
    context.textAlign = "left";
    context.textBaseline = "middle";
    context.fillText(text, x + 8, y + 12);
  }

  retheme();
  return stage;
}
