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
  "loop/describe": Described;
  "loop/open": Described;
  "loop/step": LoopAnswer;
  "loop/write": { changed: number; words: number };
  formulas: FormulaElements;
  check: Checked;
  "first/sheet": Sheet;
  "first/known": CheckedConstants;
  "next/expected": ExpectedRuns;
  "upload/survey": Surveyed;
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
