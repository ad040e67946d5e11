/** What the server sends to the page, as JSON: `serve/views.rs`, `serve/views/` and `serve/upload/proposal.rs`. */

/** State of a tab. */
interface State extends ErrorMap<Cell, MeasuredChannel> {
  campaign: string;
  description: string;
  /** Name and kind of the first model. */
  model: string;
  /** Name of the first model before it; null if there is none. */
  earlier_model: string | null;
  /** The steps from data to a saved calibration. */
  way: WayStep[];
  constants: { names: string[]; fitted: FittedConstants | null };
  tuned: TunedCalibration | null;
  /** What the terms of results mean. */
  words: { term: string; means: string }[];
  /** Each with its error in sigma. */
  runs: { file: string; conditions: string; error: number | null }[];
  /** Error of all channels, sigma. */
  error: number;
  second: SecondModel | null;
  steps: Step[];
  /** Index of the present step. */
  at: number;
  effects: AddedEffect[];
  ranking: Ranking | null;
  explained: Explained | null;
  /** Title of the running computation. */
  job: string | null;
}

/** A step of the way: its state in words, and the tab where it is made. */
interface WayStep {
  key: string;
  title: string;
  tab: string;
  done: boolean;
  state: string;
}

/** Constants of the first model that were fitted. */
interface FittedConstants {
  error_before: number;
  error_after: number;
  headings: string[];
  /** Cells as text, and whether the constant moved further than its tolerance. */
  rows: { cells: string[]; beyond: boolean }[];
  not_determined: string[];
  at_an_end: string[];
}

/** A tuned calibration: its figures as text with whether their limits are met, and its changed values. */
interface TunedCalibration {
  sentence: string | null;
  headings: string[];
  figures: { cells: string[]; met: boolean | null }[];
  changes: { key: string; before: number; after: number }[];
}

interface MeasuredChannel extends Channel {
  unit: string;
  /** One sigma, in the unit. */
  noise: number;
}

interface Step {
  title: string;
  error: number;
  held_out: number | null;
}

interface BeforeAfter {
  /** Errors in sigma. */
  before: number;
  after: number;
}

/** Comparison with a second model. */
interface SecondModel extends BeforeAfter {
  title: string;
  model: string;
  step: number | null;
  is_after: boolean;
  is_present: boolean;
  has_other_linkage: boolean;
  channels: (BeforeAfter & { key: string })[];
  changes: Change[];
  cells: Cell[];
}

type Change = Group & BeforeAfter;

type ComparedChannel = MeasuredChannel & BeforeAfter;

interface Effect {
  /** Name with its form. */
  name: string;
  id: string;
  title: string;
  equation: string;
  shows: string;
  source: string;
  parameters: { name: string; meaning: string }[];
}

interface AddedEffect {
  effect: Effect;
  parameters: AddedParameter[];
}

/** A parameter with the range of its slider. */
interface AddedParameter {
  fixed: boolean;
  name: string;
  unit: string;
  meaning: string;
  value: number;
  low: number | null;
  high: number | null;
  scale: number;
  by_magnitude: boolean;
}

/** An estimate with its 95 % interval. */
interface Estimated {
  name: string;
  unit: string;
  value: number;
  low: number | null;
  high: number | null;
}

interface Candidate {
  effect: Effect;
  /** Share of the error above the noise, 0 to 1. */
  explains: number;
  error_after: number;
  /** Absent while others are being evaluated. */
  confidence?: number;
  in_words?: string;
  indistinguishable?: string[];
  parameters: Estimated[];
}

interface Ranking {
  error_before: number;
  candidates: Candidate[];
  next_experiment: string | null;
  constants_hint: string | null;
}

interface ExplainedStep {
  effect: Effect;
  changed_from: number | null;
  error_before: number;
  error_after: number;
  held_out_after: number | null;
  confidence: number;
  in_words: string;
  indistinguishable: string[];
  parameters: Estimated[];
}

interface Explained {
  verdict: string;
  meaning: string;
  constants: Constants | null;
  steps: ExplainedStep[];
  /** Whether the search ended, at its limit or cancelled, before its result was stable. */
  unfinished: boolean;
  /** Why effects that reduce the error are not named, a sentence each. */
  doubtful: string[];
  suggested: Suggested | null;
  not_visible: string[];
  next_experiment: string | null;
}

/** Corrected constants of the base model. */
interface Constants {
  sentence: string;
  /** Why there are no intervals. */
  withheld: string | null;
  moved: { name: string; unit: string; declared: number; fitted: number; low: number | null; high: number | null }[];
  curves: { valve: string; low: number; high: number }[];
}

interface Suggested {
  place: string;
  formula: string;
  parameters: Estimated[];
  held_out_before: number | null;
  held_out_after: number | null;
  replaces: string[];
}

/** A computation: its kind, and its arguments. */
type Task = { task: string } & Record<string, unknown>;

/** A value of a parameter that is tried. */
interface Trial {
  effect: number;
  parameter: number;
  value: number;
}

/** Progress of a computation. */
type Message = { kind: "progress"; text: string; fraction: number | null; error: number | null }
  | { kind: "candidate"; candidate: Candidate; fraction: number }
  | { kind: "done" }
  | { kind: "failed"; text: string };

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
