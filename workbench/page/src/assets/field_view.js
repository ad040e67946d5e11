// @ts-check
/** Drawing of the work on a field: the ground that passes under the tractor, the implement at its depth, and the forces on it. */
import { byId } from "./dom.js";
import { jointsAt, place, shape } from "./linkage.js";

/** @typedef {[number, number]} Point x to the rear of the rear axle, y above the ground, m */

/** Part that every window shows, m: left, right, lowest, highest. Wide windows show more ground on both sides. */
const LEFT = -3.6, RIGHT = 4.6, LOW = -0.75, HIGH = 2.75;

/** Joints of the linkage: lift arm end D, rod joint E, pivot F, hitch point G. */
const [D, E, F, G] = [2, 3, 4, 5];

/** Hitch point above the tips of the shares, m, and pivot of the links behind the rear axle, m: as ploughs and tractors are. */
const HITCH_M = 0.55, PIVOT_M = 0.2;

/** Radius of the front wheels, m. */
const FRONT_M = 0.5;

/** Length of an arrow, m per kN; the tip of an arrow, m; forces below it are not drawn, kN. */
const M_PER_KN = 0.055, TIP_M = 0.09, LEAST_KN = 0.2;

/** Height of the values of the forces above the ground, m: a working implement is below. */
const VALUES_M = 0.75;

/** Height of letters, px. */
const LETTERS_PX = 13;

/** Names of the textures. */
const SOILS = /** @type {Record<string, string>} */ ({ coarse: "sand (coarse)", medium: "loam (medium)", fine: "clay (fine)" });

/** A drawing of a machine.
 * @typedef {ReturnType<typeof drawField>} FieldDrawing */

/** Draws the fixed parts, and returns the function that moves the others.
 * @param {SVGSVGElement} svg
 * @param {DescribedField} of
 * @param {DrawnLinkage} linkage */
export function drawField(svg, of, linkage) {
  svg.setAttribute("viewBox", `${LEFT} ${-HIGH} ${RIGHT - LEFT} ${HIGH - LOW}`);
  const touch = jointsAt(/** @type {any} */ (linkage.positions), of.touch_deg);
  /** From the linkage to the drawing.
   * @param {Point} point
   * @returns {Point} */
  const seated = ([x, y]) => [x - touch[F][0] + PIVOT_M, y - touch[G][1] + HITCH_M];
  const soil = shape("g", {}), worked = shape("path", { class: "worked" }), surface = shape("path", { class: "surface" });
  const body = tractor(of);
  const links = { arm: shape("line", {}), rod: shape("line", {}), link: shape("line", { class: "strong" }) };
  body.append(links.arm, links.rod, links.link);
  const wheels = [wheel(of.rear_radius_m), wheel(FRONT_M)];
  const plough = shape("path", { class: "plough" });
  const [draft, vertical] = [arrow("draft", 1), arrow("vertical", 0)];
  const names = shape("g", {});
  svg.replaceChildren(soil, worked, surface, body, ...wheels.map((one) => one.group), plough, draft.group, vertical.group, names);
  /** Distances of the share and heights of its tip, m, in the order of the travel.
   * @type {Point[]} */
  let track = [];
  let turned_m = 0, known_m = 0;

  /** @param {FieldNow} now
   * @param {number} angle_deg
   * @param {number} elapsed_s */
  return (now, angle_deg, elapsed_s) => {
    const ground = now.ground;
    const height = (/** @type {number} */ x) => groundAt(ground, -x);
    const letters_m = LETTERS_PX / (svg.getScreenCTM()?.a || 60);
    drawSoil(soil, names, ground, letters_m);
    surface.setAttribute("d", path(ground.height_m.map((y, index) => /** @type {Point} */ ([-(ground.from_m + index * ground.step_m), y]))));

    const [rear_m, front_m] = now.axles_m;
    const tilt = (front_m - rear_m) / of.wheelbase_m;
    body.setAttribute("transform", `matrix(1 ${tilt} 0 1 0 ${-rear_m})`);
    const joints = jointsAt(/** @type {any} */ (linkage.positions), angle_deg).map(seated);
    place(links.arm, seated([0, 0]), joints[D]);
    place(links.rod, joints[D], joints[E]);
    place(links.link, joints[F], joints[G]);

    // A new start begins at distance 0.
    if (now.distance_m < known_m) [track, turned_m] = [[], 0];
    known_m = now.distance_m;
    turned_m += now.wheel_speed_m_s * elapsed_s;
    wheels[0].move(0, height(0), turned_m);
    wheels[1].move(-of.wheelbase_m, height(-of.wheelbase_m), now.distance_m);

    const tip = height(of.share_m) - now.depth_m;
    const [x, y] = joints[G];
    plough.setAttribute("d", ploughPath([x, y + rear_m - tilt * x], of, tip));
    track.push([now.distance_m - of.share_m, Math.min(tip, height(of.share_m))]);
    track = track.filter(([at_m]) => at_m > now.distance_m + ground.from_m);
    const floor = track.map(([at_m, y]) => /** @type {Point} */ ([now.distance_m - at_m, y])).filter(([x]) => x >= of.share_m);
    const above = [...floor].reverse().map(([x]) => /** @type {Point} */ ([x, height(x)]));
    worked.setAttribute("d", floor.length > 1 ? `${path([...floor, ...above])}Z` : "");

    draft.move([of.share_m, tip], [now.draft_kn, 0], `draft ${now.draft_kn.toFixed(1)} kN`, letters_m);
    vertical.move([of.share_m, tip], [0, now.vertical_kn], `vertical ${signed(now.vertical_kn)} kN`, letters_m);
  };
}

/** @param {number} value */
export function signed(value) {
  return `${value > 0 ? "+" : value < 0 ? "\u2212" : ""}${Math.abs(value).toFixed(1)}`;
}

/** Height of the ground at a distance in front of the rear axle, m.
 * @param {DrawnGround} ground
 * @param {number} ahead_m */
function groundAt({ from_m, step_m, height_m }, ahead_m) {
  const at = Math.min(height_m.length - 1, Math.max(0, (ahead_m - from_m) / step_m));
  const below = Math.min(height_m.length - 2, Math.floor(at));
  return height_m[below] + (height_m[below + 1] - height_m[below]) * (at - below);
}

/** @param {Point[]} points */
function path(points) {
  return `M${points.map(([x, y]) => `${x.toFixed(3)} ${(-y).toFixed(3)}`).join("L")}`;
}

/** Fills the ground by texture, with a mark on soft patches, and names what is long enough.
 * @param {SVGElement} soil
 * @param {SVGElement} names
 * @param {DrawnGround} ground
 * @param {number} letters_m */
function drawSoil(soil, names, ground, letters_m) {
  const kinds = ground.texture.map((texture, index) => `${texture}${ground.soft[index] ? " soft" : ""}`);
  const parts = [], texts = [];
  for (let from = 0; from < kinds.length - 1;) {
    let to = from + 1;
    while (to < kinds.length - 1 && kinds[to] === kinds[from]) to += 1;
    const top = Array.from({ length: to - from + 1 }, (_, index) => from + index)
      .map((index) => /** @type {Point} */ ([-(ground.from_m + index * ground.step_m), ground.height_m[index]]));
    const [ahead, behind] = [top[top.length - 1][0], top[0][0]];
    parts.push(shape("path", { class: kinds[from], d: `${path([...top, [ahead, LOW], [behind, LOW]])}Z` }));
    const [left, right] = [Math.max(LEFT, ahead), Math.min(RIGHT, behind)];
    const text = SOILS[ground.texture[from]] + (ground.soft[from] ? ", soft patch" : "");
    if (right - left > 0.55 * letters_m * text.length) texts.push(label(text, [(left + right) / 2, LOW + 0.1], letters_m, "middle"));
    from = to;
  }
  soil.replaceChildren(...parts);
  names.replaceChildren(...texts);
}

/** @param {string} text
 * @param {Point} at
 * @param {number} letters_m
 * @param {string} anchor */
function label(text, [x, y], letters_m, anchor) {
  const made = shape("text", { x, y: -y, "font-size": letters_m, "text-anchor": anchor });
  made.textContent = text;
  return made;
}

/** Hood, cab and frame; the travel is to the left.
 * @param {DescribedField} of */
function tractor({ wheelbase_m, rear_radius_m }) {
  const group = shape("g", { class: "tractor" });
  const front = -wheelbase_m - 0.45, floor = rear_radius_m - 0.1;
  group.append(
    shape("path", { d: `M${front} ${-floor}V-1.35L-0.75 -1.55V${-floor}Z` }),
    shape("path", { d: `M-0.8 ${-floor}V-1.6L-0.6 -2.6H0.45L0.6 -1.6V${-floor}Z` }),
    shape("path", { class: "window", d: "M-0.66 -1.62L-0.5 -2.45H0.36L0.48 -1.62Z" }));
  return group;
}

/** A wheel with spokes.
 * @param {number} radius_m */
function wheel(radius_m) {
  const group = shape("g", { class: "wheel" });
  const spokes = shape("path", { d: `M${-radius_m * 0.55} 0H${radius_m * 0.55}M0 ${-radius_m * 0.55}V${radius_m * 0.55}` });
  group.append(shape("circle", { r: radius_m }), shape("circle", { class: "rim", r: radius_m * 0.55 }), spokes);
  return {
    group,
    /** @param {number} x
     * @param {number} ground_m
     * @param {number} rolled_m */
    move(x, ground_m, rolled_m) {
      group.setAttribute("transform", `translate(${x} ${-(ground_m + radius_m)})`);
      // To the left, it turns against the clock.
      spokes.setAttribute("transform", `rotate(${-(rolled_m / radius_m * 180 / Math.PI) % 360})`);
    },
  };
}

/** A beam from the hitch point, and three shares.
 * @param {Point} hitch
 * @param {DescribedField} of
 * @param {number} tip height of the tips, m */
function ploughPath([x, y], { share_m, share_line_m }, tip) {
  const beam = tip + HITCH_M, step = share_line_m / 3;
  const shares = [-step, 0, step].map((by) => share_m + by);
  const legs = shares.map((at) => `M${at + 0.12} ${-beam}L${at + 0.1} ${-tip - 0.16}L${at - 0.14} ${-tip}H${at + 0.2}L${at + 0.1} ${-tip - 0.16}`);
  return `M${x} ${-y}L${shares[0]} ${-beam}H${shares[2] + 0.12}${legs.join("")}`;
}

/** An arrow with its value, which is written in a line above the implement.
 * @param {string} name
 * @param {number} above number of lines below it */
function arrow(name, above) {
  const group = shape("g", { class: `arrow ${name}` });
  const line = shape("line", {}), tip = shape("path", {});
  const text = label("", [RIGHT - 0.1, 0], 0.2, "end");
  group.append(line, tip, text);
  return {
    group,
    /** @param {Point} from
     * @param {[number, number]} force rearwards and upwards, kN
     * @param {string} value
     * @param {number} letters_m */
    move(from, force, value, letters_m) {
      const size_kn = Math.hypot(...force);
      group.setAttribute("visibility", size_kn < LEAST_KN ? "hidden" : "visible");
      if (size_kn < LEAST_KN) return;
      const [ux, uy] = force.map((part) => part / size_kn);
      const length = size_kn * M_PER_KN;
      const to = /** @type {Point} */ ([from[0] + ux * length, from[1] + uy * length]);
      place(line, from, to);
      tip.setAttribute("d", `${path([to, [to[0] - TIP_M * (ux - uy / 2), to[1] - TIP_M * (uy + ux / 2)], [to[0] - TIP_M * (ux + uy / 2), to[1] - TIP_M * (uy - ux / 2)]])}Z`);
      text.textContent = value;
      text.setAttribute("y", String(-(VALUES_M + above * 1.25 * letters_m)));
      text.setAttribute("font-size", String(letters_m));
    },
  };
}

/** Shows a state in words above the drawing.
 * @param {FieldNow} now */
export function tellField(now) {
  const kmh = (/** @type {number} */ speed_m_s) => `${(speed_m_s * 3.6).toFixed(1)} km/h`;
  const set = (/** @type {string} */ key, /** @type {string} */ text) => {
    const cell = byId(`field-${key}`);
    if (cell.textContent !== text) cell.textContent = text;
  };
  set("ground-speed", kmh(now.ground_speed_m_s));
  set("wheel-speed", kmh(now.wheel_speed_m_s));
  set("slip-now", `${(now.slip * 100).toFixed(1)} %`);
  set("distance", `${now.distance_m.toFixed(0)} m`);
  set("work", now.in_work === null ? "not known" : now.in_work ? "in work" : "not in work");
  set("reason", now.trouble_text ? `${now.reason_text}; sensor lost: ${now.trouble_text}` : now.reason_text);
}
