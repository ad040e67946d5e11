/** What the program sends to the scripts of the page and of the reports, as JSON: `serve/views.rs`, `report/error_map.rs` and
 * `report/plotted.rs`. A number that is not finite is `null`. */

interface Channel {
  key: string;
  title: string;
  /** Error in sigma. */
  error: number;
}

/** A group of samples of a channel. */
interface Group {
  by: string;
  part: string;
  channel: string;
}

/** The error of a model in a group. */
interface Cell extends Group {
  /** Root mean square in sigma. */
  error: number | null;
  samples: number;
  /** In a report: the stretch with the largest error. */
  worst?: (Place & { run: number; error: number }) | null;
}

interface ErrorMap<C extends Group = Cell, H extends Channel = Channel> {
  groupings: { by: string; title: string }[];
  channels: H[];
  cells: C[];
}

/** A stretch of time of a run, with its channel. */
interface Place {
  from_s: number;
  to_s: number;
  channel?: string;
}

type Samples = (number | null)[];

interface RunChannel {
  key: string;
  title: string;
  unit: string;
  error: number;
  measured: Samples;
  simulated: Samples;
  residual: Samples;
  /** Of the first model, if it is another one. */
  first?: Samples | null;
  first_residual?: Samples | null;
  second?: { simulated: Samples; residual: Samples; error: number } | null;
  /** The part of the residual that an effect explains. */
  signature?: Samples;
}

/** A run with its channels, or a plot with rows of its own. */
interface PlotView {
  time_s: number[];
  names?: { first?: string; simulated?: string; second?: string } | null;
  lift_current_a?: Samples;
  lower_current_a?: Samples;
  channels?: RunChannel[];
  rows?: PlotRow[];
  span?: [number, number];
  x_title?: string;
  /** Parts that are not drawn: residuals, currents. */
  without?: string[];
}

/** A run on the page. */
interface RunView extends PlotView {
  run: number;
  file: string;
  conditions: string;
  lift_current_a: Samples;
  lower_current_a: Samples;
  channels: RunChannel[];
}

interface PlotRow {
  title: string;
  unit: string;
  /** Preferred height, px. */
  height?: number;
  /** Largest number of ticks of its axis. */
  ticks?: number;
  /** Whether the band of the noise is drawn. */
  band?: boolean;
  lines: PlotLine[];
}

interface PlotLine {
  name: string;
  /** Lines with the same key share an entry of the legend. */
  key: string;
  colour: string;
  dash?: string | null;
  width?: number;
  /** Its own abscissa. */
  x?: number[] | null;
  y: Samples;
  unit?: string;
  of?: string;
  /** Whether it depends on the parameters of the model. */
  changes?: boolean;
}
