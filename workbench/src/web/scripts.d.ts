/** What only the scripts have: parts of views, arguments of requests, and what is drawn. What the program sends is in `views.d.ts`. */

/** A group of samples of a channel. */
type Group = Pick<Cell, "by" | "part" | "channel">;

/** A column of an error map. */
type Channel = Pick<MeasuredChannel, "key" | "title" | "error">;

interface ErrorMap<C extends Group = Cell, H extends Channel = Channel> {
  groupings: GroupingTitle[];
  channels: H[];
  cells: C[];
}

/** Errors of two models, sigma. */
type BeforeAfter = Pick<SecondModel, "before" | "after">;

type ComparedChannel = MeasuredChannel & BeforeAfter;

/** A stretch of time of a run, with its channel. */
type Place = Pick<WorstStretch, "from_s" | "to_s"> & Partial<WorstStretch>;

interface RunChannel {
  /** The part of the residual that a selected effect explains. */
  signature?: Samples;
}

interface RunView {
  /** Parts that are not drawn: residuals, currents. */
  without?: string[];
}

/** A run with its channels, or a plot with rows of its own. */
type PlotView = Partial<RunView & RowPlot> & Pick<RowPlot, "time_s">;

interface PlotRow {
  /** Largest number of ticks of its axis. */
  ticks?: number;
  /** Whether the band of the noise is drawn. */
  band?: boolean;
}

interface PlotLine {
  unit?: string;
  /** Title of its channel. */
  of?: string;
  /** Whether it depends on the parameters of the model. */
  changes?: boolean;
}

/** What requests answer. */
interface Answers {
  begin: Begun;
  state: State;
  run: RunView;
  worst: LocatedWorstStretch;
  "second/largest": LocatedChangedStretch;
  signature: Signatures;
  preview: SimulatedChannels;
  "preview/all": TriedRuns;
}

/** The answer to a request. */
type Answer<P extends string> = P extends keyof Answers ? Answers[P] : any;

/** A computation: its kind, and its arguments. */
type Task = { task: string } & Record<string, unknown>;

/** A value of a parameter that is tried. */
interface Trial {
  effect: number;
  parameter: number;
  value: number;
}

/** The proposed assignment of logs. */
interface Proposal {
  name: string;
  logs: ProposedLog[];
  groups: ProposedGroup[];
  signals: Signal[];
}

interface ProposedLog {
  file: string;
  load_kg: number | null;
}

interface Signal {
  key: string;
  /** Name for a reader. */
  title: string;
  unit: string;
  units: string[];
  /** Units of a sensor, with which two points have to be known. */
  raw: string[];
}

/** Logs with equal columns. */
interface ProposedGroup {
  files: string[];
  times: boolean;
  own_units: boolean;
  columns: { name: string; unit: string | null }[];
  taken: { channel: string; column: string; unit: string | null; reason: string; assumed: boolean }[];
  /** What was assumed, and columns of a signal that are left out with the reason. */
  notes: string[];
  /** The other columns that are not used. */
  unused: string[];
  untold: string | null;
}
