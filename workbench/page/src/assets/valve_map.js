// @ts-check
/** Flow over current in both calibrations. */
import { byId, colour } from "./dom.js";
import { library } from "./run_plot.js";

/** Valves: key, title, colour. */
const VALVES = /** @type {[keyof ValveMaps, string, string][]} */ ([["lift", "lift valve", "lift"], ["lower", "lowering valve", "lower"]]);

/** Draws the maps, that of the first model dashed.
 * @param {ValveMaps[]} maps */
export async function drawMaps(maps) {
  const plotly = await library;
  const styles = [{ name: "first", dash: "dash", width: 1.6 }, { name: "rebuilt", dash: "solid", width: 2 }];
  const traces = VALVES.flatMap(([key, title, shade]) => styles.map((style, index) => ({
    type: "scatter", mode: "lines", name: `${title}, ${style.name}`, x: maps[index][key].current_a, y: maps[index][key].flow_lpm,
    line: { color: colour(shade), width: style.width, dash: style.dash }, hovertemplate: "%{y:.2f} l/min at %{x:.3f} A" })));
  const narrow = matchMedia("(max-width: 40rem)").matches;
  await plotly.react(byId("valve-map"), traces, {
    height: narrow ? 340 : 300, margin: { l: 52, r: 12, t: 8, b: narrow ? 130 : 84 }, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: colour("paper"),
    font: { color: colour("ink"), size: 12 }, showlegend: true, dragmode: false,
    legend: { orientation: "h", x: 0, xanchor: "left", y: 0, yref: "container", yanchor: "bottom" },
    hoverlabel: { bgcolor: colour("card"), font: { color: colour("ink") } },
    xaxis: { title: { text: "current, A", standoff: 4 }, range: [0.8, 3.5], fixedrange: true, gridcolor: colour("line"), zeroline: false },
    yaxis: { title: { text: "flow, l/min" }, rangemode: "tozero", fixedrange: true, gridcolor: colour("line"),
      zerolinecolor: colour("band") },
  }, { displayModeBar: false, responsive: true });
  const threshold = (/** @type {ValveMaps} */ map, /** @type {keyof ValveMaps} */ key) => map[key].threshold_a.toFixed(3);
  byId("valve-text").textContent = VALVES.map(([key, title]) =>
    `Threshold of the ${title}: ${threshold(maps[0], key)} A → ${threshold(maps[1], key)} A.`).join(" ");
}
