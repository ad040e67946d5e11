/** The part of plotly.js that the scripts use. Traces and layouts are checked by the library. */

type PlotTrace = Record<string, unknown>;

interface PlotAxis {
  range?: [number, number];
  [name: string]: unknown;
}

interface PlotLayout {
  xaxis: PlotAxis & { title: { text: string; standoff?: number; font?: { size: number } } };
  margin: { l: number; r: number; t: number; b: number };
  shapes: object[];
  annotations: object[];
  height?: number;
  [name: string]: unknown;
}

/** An element with a plot. */
interface Plotted extends HTMLElement {
  /** Absent before the first drawing. */
  layout?: { xaxis: { range: [number, number] }; margin: { l: number; r: number }; [axis: string]: any };
  data?: PlotTrace[];
  on(event: string, listener: (change: Record<string, number | undefined>) => void): void;
}

interface Plotly {
  react(at: HTMLElement, traces: PlotTrace[], layout: object, options: object): Promise<void>;
  relayout(at: HTMLElement, change: object): Promise<void>;
  Plots: { resize(at: HTMLElement): Promise<void> };
}

interface Window {
  Plotly?: Plotly;
}
