// Solids in three dimensions: converts the volumes of a body to triangles.

const AROUND_BARREL = 48, AROUND_TUBE = 14; // number of sides of a circle
const CHIME = 0.022, CROZE = 0.032; // thickness of staves at the ends and depth of the heads of a barrel 0.95 m long (m)
const HOOPS = [0.93, 0.62, 0.3]; // positions of the hoops on each side, as shares of half the length

const plus = (a, b, by = 1) => [a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => plus([0, 0, 0], a, 1 / (Math.hypot(...a) || 1));

function makeMesh() {
  return { places: [], normals: [], maps: [], faces: [] };
}

// Returns axes about which a profile is revolved; the second axis points up where possible.
function frameOf(at, axis) {
  const up = Math.abs(axis[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
  const v = unit(plus(up, axis, -dot(up, axis)));
  return { at, axis, u: cross(v, axis), v };
}

// Adds the surface of revolution of a profile of [position along the axis, radius]; the outside is
// to the left of the profile. A smooth surface has one normal per point, others one per segment.
function revolve(mesh, frame, profile, sides, smooth, map) {
  const pieces = smooth ? [profile] : profile.slice(1).map((point, k) => [profile[k], point]);
  for (const piece of pieces) {
    const first = mesh.places.length / 3;
    piece.forEach(([x, r], k) => {
      const [before, after] = [piece[Math.max(0, k - 1)], piece[Math.min(piece.length - 1, k + 1)]];
      const [dx, dr] = [after[0] - before[0], after[1] - before[1]], size = Math.hypot(dx, dr) || 1;
      for (let side = 0; side <= sides; side++) {
        const angle = (2 * Math.PI * side) / sides, cos = Math.cos(angle), sin = Math.sin(angle);
        const around = plus(plus([0, 0, 0], frame.u, cos), frame.v, sin);
        mesh.places.push(...plus(plus(frame.at, frame.axis, x), around, r));
        mesh.normals.push(...plus(plus([0, 0, 0], frame.axis, -dr / size), around, dx / size));
        mesh.maps.push(...map(side / sides, x, r, cos, sin));
      }
    });
    const row = sides + 1;
    for (let k = 0; k + 1 < piece.length; k++) {
      for (let side = 0; side < sides; side++) {
        const a = first + k * row + side, c = a + row;
        mesh.faces.push(a, a + 1, c, a + 1, c + 1, c);
      }
    }
  }
}

const flatMap = () => [0, 0];

function addBlock(mesh, at, [a, b, c]) {
  // The sides of a left-handed block would face inward.
  const sides = dot(cross(a, b), c) < 0 ? [a, c, b] : [a, b, c];
  for (let k = 0; k < 3; k++) {
    for (const sign of [-1, 1]) {
      const out = sides[k], [p, q] = [sides[(k + 1) % 3], sides[(k + 2) % 3]];
      const first = mesh.places.length / 3, normal = unit(plus([0, 0, 0], out, sign));
      for (const [s, t] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
        mesh.places.push(...plus(plus(plus(at, out, sign), p, s * sign), q, t));
        mesh.normals.push(...normal);
        mesh.maps.push(0, 0);
      }
      mesh.faces.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  }
}

const threes = (list) => Array.from({ length: list.length / 3 }, (_, k) => list.slice(3 * k, 3 * k + 3));
const pairs = (list) => Array.from({ length: list.length / 2 }, (_, k) => list.slice(2 * k, 2 * k + 2));

function addVolume(mesh, volume) {
  if (volume.block) return addBlock(mesh, volume.block, threes(volume.sides));
  if (volume.ball) {
    const steps = 16, at = (k) => (Math.PI * k) / steps;
    const profile = Array.from({ length: steps + 1 }, (_, k) => [-volume.radius * Math.cos(at(k)), volume.radius * Math.sin(at(k))]);
    return revolve(mesh, frameOf(volume.ball, [1, 0, 0]), profile, 2 * steps, true, flatMap);
  }
  if (volume.tube) {
    const [from, to] = threes(volume.tube), along = plus(to, from, -1), r = volume.radius;
    // A tube of zero length is drawn as a knob as long as it is thick.
    const length = Math.hypot(...along), [low, high] = length > 1e-3 ? [0, length] : [-r, r];
    const frame = frameOf(from, length > 1e-3 ? unit(along) : [0, 0, 1]);
    return revolve(mesh, frame, [[low, 0], [low, r], [high, r], [high, 0]], AROUND_TUBE, false, flatMap);
  }
  const profile = pairs(volume.turned), ends = [profile[0][0], profile.at(-1)[0]];
  const frame = frameOf(volume.at, volume.axis);
  revolve(mesh, frame, [[ends[0], 0], profile[0]], AROUND_BARREL, false, flatMap);
  revolve(mesh, frame, profile, AROUND_BARREL, true, flatMap);
  return revolve(mesh, frame, [profile.at(-1), [ends[1], 0]], AROUND_BARREL, false, flatMap);
}

// Adds a barrel: staves, heads set back behind the chimes, hoops, the bung, and a place for the
// name on both heads.
function addBarrel({ wood, head, steel, label }, volume) {
  const profile = pairs(volume.turned), frame = frameOf(volume.at, volume.axis);
  const half = profile.at(-1)[0], size = half / 0.475, rim = profile.at(-1)[1] - CHIME * size, inner = half - CROZE * size;
  const radius = (x) => {
    const k = Math.min(Math.max(profile.findIndex((point) => point[0] >= x), 1), profile.length - 1);
    const [a, b] = [profile[k - 1], profile[k]];
    return a[1] + ((b[1] - a[1]) * (x - a[0])) / (b[0] - a[0]);
  };
  const staves = (share, x) => [share, 0.5 + (0.5 * x) / half];
  const disc = (_, x, r, cos, sin) => [0.5 + (0.5 * r * cos) / rim, 0.5 + (0.5 * r * sin) / rim];
  revolve(wood, frame, profile, AROUND_BARREL, true, staves);
  revolve(wood, frame, [[-inner, rim], [-half, rim], profile[0]], AROUND_BARREL, false, staves);
  revolve(wood, frame, [profile.at(-1), [half, rim], [inner, rim]], AROUND_BARREL, false, staves);
  revolve(head, frame, [[-inner, 0], [-inner, rim]], AROUND_BARREL, false, disc);
  revolve(head, frame, [[inner, rim], [inner, 0]], AROUND_BARREL, false, disc);
  for (const place of HOOPS.flatMap((share) => [-share * half, share * half])) {
    const thick = 0.005 * size, wide = 0.024 * size;
    const [from, to] = [Math.max(place - wide, -half + 1e-3), Math.min(place + wide, half - 1e-3)];
    const hoop = [[from, radius(from)], [from, radius(from) + thick], [to, radius(to) + thick], [to, radius(to)]];
    revolve(steel, frame, hoop, AROUND_BARREL, false, flatMap);
  }
  const bung = frameOf(volume.at, frame.v), bilge = radius(0);
  revolve(steel, bung, [[0.9 * bilge, 0.03 * size], [bilge + 0.012 * size, 0.03 * size], [bilge + 0.012 * size, 0]], AROUND_TUBE, false, flatMap);
  for (const side of [-1, 1]) {
    const first = label.places.length / 3, [wide, high] = [0.9 * rim, 0.45 * rim];
    for (const [s, t] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      const place = plus(frame.at, frame.axis, side * (inner + 0.003 * size));
      label.places.push(...plus(plus(place, frame.u, side * s * wide), frame.v, t * high));
      label.normals.push(...plus([0, 0, 0], frame.axis, side));
      label.maps.push(0.5 + 0.5 * s, 0.5 + 0.5 * t);
    }
    label.faces.push(first, first + 1, first + 2, first, first + 2, first + 3);
  }
}

// Returns the meshes of a list of volumes, by material.
function meshesOf(volumes, role) {
  const meshes = {};
  const mesh = (name) => (meshes[name] ??= makeMesh());
  for (const volume of volumes) {
    if (role === "barrel" && volume.turned) addBarrel({ wood: mesh("wood"), head: mesh("head"), steel: mesh("steel"), label: mesh("label") }, volume);
    else addVolume(mesh(role === "barrel" ? "wood" : role), volume);
  }
  return meshes;
}

// Draws the grain and the seams of wood, around a barrel or across a head; the picture is
// multiplied with the color.
function woodPicture(boards, across, wide, high) {
  const picture = make("canvas", { width: wide, height: high });
  const context = picture.getContext("2d");
  let seed = 20140824;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  for (let board = 0; board < boards; board++) {
    const [x, width] = [(board * wide) / boards, wide / boards];
    const light = 205 + 46 * random();
    context.fillStyle = `rgb(${light} ${light - 4} ${light - 10})`;
    context.fillRect(x, 0, width + 1, high);
    for (let k = 0; k < 16; k++) {
      context.fillStyle = `rgb(70 45 20 / ${0.03 + 0.07 * random()})`;
      context.fillRect(x + random() * width, 0, 0.5 + 1.6 * random(), high);
    }
    context.fillStyle = "rgb(50 30 15 / .5)";
    context.fillRect(x, 0, Math.max(1.4, wide / 500), high);
  }
  if (across) return picture;
  // Darker toward the ends, as from handling and hoops.
  const shade = context.createLinearGradient(0, 0, 0, high);
  for (const [at, dark] of [[0, 0.3], [0.1, 0.08], [0.5, 0], [0.9, 0.08], [1, 0.3]]) shade.addColorStop(at, `rgb(60 35 15 / ${dark})`);
  context.fillStyle = shade;
  context.fillRect(0, 0, wide, high);
  return picture;
}
