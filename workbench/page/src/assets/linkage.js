// @ts-check
/** Drawing of the three-point linkage, from the joints that the server has solved over the swing. */

/** @typedef {[number, number]} Point */
/** @typedef {{angle_deg: number, joints: Point[]}} Position */

const NAMESPACE = "http://www.w3.org/2000/svg";

/** Indices of the joints: piston pin A, rocker end B, lift arm end D, rod joint E, pivot F, hitch point G. */
const [A, B, D, E, F, G] = [0, 1, 2, 3, 4, 5];

/** The rocker shaft C.
 * @type {Point} */
const SHAFT = [0, 0];

/** Margin around the drawing, and half height of the cylinder, m. */
const MARGIN_M = 0.12, BORE_M = 0.045;

/** Distances of the ends of the cylinder from the ends of the piston pin's travel, m. */
const BEHIND_M = 0.07, AHEAD_M = 0.05;

/** Half length of the piston, m. */
const PISTON_M = 0.03;

/** Load, kg, of a drawn weight of a metre's edge. */
const HEAVY_KG = 12_000;

/** An element of a drawing.
 * @param {string} name
 * @param {Record<string, string | number>} attributes */
export function shape(name, attributes) {
  const made = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}

/** The joints at an angle.
 * @param {Position[]} positions
 * @param {number} angle_deg
 * @returns {Point[]} */
export function jointsAt(positions, angle_deg) {
  const [first, last] = [positions[0].angle_deg, positions[positions.length - 1].angle_deg];
  const place = (angle_deg - first) / (last - first) * (positions.length - 1);
  const below = Math.min(positions.length - 2, Math.max(0, Math.floor(place)));
  const share = Math.min(1, Math.max(0, place - below));
  const [from, to] = [positions[below].joints, positions[below + 1].joints];
  return from.map(([x, y], joint) => [x + (to[joint][0] - x) * share, y + (to[joint][1] - y) * share]);
}

/** Draws the fixed parts, and returns the function that moves the others.
 * @param {SVGSVGElement} svg
 * @param {{positions: Position[]}} linkage
 * @returns {(set_point_deg: number, first_deg: number, present_deg: number, load_kg: number) => void} */
export function drawLinkage(svg, { positions }) {
  const all = [SHAFT, ...positions.flatMap((position) => position.joints)];
  const [xs, ys] = [all.map((point) => point[0]), all.map((point) => -point[1])];
  const pins = positions.map((position) => position.joints[A][0]);
  const [back, front] = [Math.min(...pins) - BEHIND_M, Math.max(...pins) + AHEAD_M];
  const left = Math.min(...xs, back) - MARGIN_M, top = Math.min(...ys) - MARGIN_M;
  const width = Math.max(...xs) + MARGIN_M - left, height = Math.max(...ys) + 2 * MARGIN_M - top;
  svg.setAttribute("viewBox", [left, top, width, height].map((one) => one.toFixed(3)).join(" "));
  const axis = positions[0].joints[A][1];
  const oil = shape("rect", { class: "oil", x: back, y: -axis - BORE_M, height: 2 * BORE_M, width: 0 });
  const cylinder = shape("rect", { class: "cylinder", x: back, y: -axis - BORE_M, height: 2 * BORE_M, width: front - back });
  const target = shape("line", { class: "target" });
  const ghost = mechanism("ghost"), present = mechanism("present");
  const pivot = positions[0].joints[F];
  svg.replaceChildren(oil, cylinder, target, ghost.group, present.group,
    shape("circle", { class: "shaft", cx: 0, cy: 0, r: 0.022 }),
    shape("circle", { class: "shaft", cx: pivot[0], cy: -pivot[1], r: 0.018 }));
  return (set_point_deg, first_deg, present_deg, load_kg) => {
    const wanted = jointsAt(positions, set_point_deg);
    place(target, wanted[F], wanted[G]);
    ghost.move(jointsAt(positions, first_deg), load_kg);
    const joints = jointsAt(positions, present_deg);
    present.move(joints, load_kg);
    oil.setAttribute("width", String(Math.max(0, joints[A][0] - PISTON_M - back)));
  };
}

/** The moving parts.
 * @param {string} name */
function mechanism(name) {
  const group = shape("g", { class: name });
  const piston = shape("rect", { class: "piston", width: 2 * PISTON_M, height: 2 * BORE_M });
  const parts = { connecting: shape("line", {}), rod: shape("line", {}), link: shape("line", { class: "strong" }) };
  const rocker = shape("polyline", { class: "strong" });
  const load = shape("rect", { class: "load" });
  const pins = [A, B, D, E, G].map(() => shape("circle", { class: "pin", r: 0.012 }));
  group.append(load, piston, parts.connecting, parts.rod, parts.link, rocker, ...pins);
  return {
    group,
    /** @param {Point[]} joints
     * @param {number} load_kg */
    move(joints, load_kg) {
      piston.setAttribute("x", String(joints[A][0] - PISTON_M));
      piston.setAttribute("y", String(-joints[A][1] - BORE_M));
      place(parts.connecting, joints[A], joints[B]);
      place(parts.rod, joints[D], joints[E]);
      place(parts.link, joints[F], joints[G]);
      rocker.setAttribute("points", [joints[B], SHAFT, joints[D]].map(([x, y]) => `${x},${-y}`).join(" "));
      [A, B, D, E, G].forEach((joint, index) => {
        pins[index].setAttribute("cx", String(joints[joint][0]));
        pins[index].setAttribute("cy", String(-joints[joint][1]));
      });
      const edge = Math.cbrt(load_kg / HEAVY_KG);
      load.setAttribute("x", String(joints[G][0] - edge / 2));
      load.setAttribute("y", String(-joints[G][1]));
      load.setAttribute("width", String(edge));
      load.setAttribute("height", String(edge));
    },
  };
}

/** Moves the ends of a line.
 * @param {SVGElement} line
 * @param {Point} from
 * @param {Point} to */
export function place(line, from, to) {
  line.setAttribute("x1", String(from[0]));
  line.setAttribute("y1", String(-from[1]));
  line.setAttribute("x2", String(to[0]));
  line.setAttribute("y2", String(-to[1]));
}
