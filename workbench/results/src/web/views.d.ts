/** What the program sends to the scripts of the page and of the reports, as JSON. A number that is not finite is `null`.
 * Generated from the Rust types: HITCH_WRITE_DECLARATIONS=1 cargo test -p hitch-page declarations */

/** A session that has begun. */
interface Begun {
  /** Its id. */
  session: string;
  /** Its state. */
  state: State;
}

/** Error of one channel in one part of the data. */
interface Cell {
  /** Grouping of the samples. */
  by: Grouping;
  /** Name of the group. */
  part: string;
  /** Key of the channel. */
  channel: string;
  /** Root mean square in sigma. */
  error: number;
  /** Mean in sigma; positive where the measurement exceeds the model. */
  bias: number;
  /** Compared samples. */
  samples: number;
}

/** Error of two models in one cell. */
interface CellChange {
  /** Grouping of the samples. */
  by: Grouping;
  /** Name of the group. */
  part: string;
  /** Key of the channel. */
  channel: string;
  /** Error of the model before, root mean square in sigma. */
  before: number;
  /** Error of the model after, root mean square in sigma. */
  after: number;
}

/** One value that was searched. */
interface Change {
  /** Group and key of the calibration file, without the unit: `group.key`. */
  key: string;
  /** Value before, in the unit of the calibration file. */
  before: number;
  /** Value after, in the unit of the calibration file. */
  after: number;
}

/** Errors of both models in a channel, sigma. */
interface ChangedChannel {
  /** Key of the channel. */
  key: string;
  /** Error of the model before. */
  before: number;
  /** Error of the model after. */
  after: number;
}

/** The stretch of time that contributes most to the change of a cell. */
interface ChangedStretch {
  /** Key of the channel. */
  channel: string;
  /** Start, s. */
  from_s: number;
  /** End, s. */
  to_s: number;
  /** Error before, root mean square in sigma. */
  before: number;
  /** Error after, root mean square in sigma. */
  after: number;
}

/** The answer about a term. */
interface Checked {
  /** What is wrong with it. */
  fault: Fault | null;
}

/** The answer about what is known of constants. */
interface CheckedConstants {
  /** What is wrong with it. */
  faults: ConstantFault[];
}

/** The connection to an ECU on the bus. */
interface Connection {
  /** Whether the adapter is connected. */
  connected: boolean;
  /** Why there are no data; `null` if they arrive. */
  problem: string | null;
  /** The connection in one sentence. */
  text: string;
  /** Reported position, percent, 0 lowest; `null` if its sensor is bad. */
  position_percent: number | null;
}

/** What is wrong with what is known of a constant. */
interface ConstantFault {
  /** Name of the constant. */
  name: string;
  /** What is wrong, and how to mend it. */
  what: string;
}

/** The constants of a session. */
interface Constants {
  /** Those that a fit moves. */
  movable: MovableConstant[];
  /** The fit of the first model's. */
  fitted: FittedConstants | null;
}

/** Corrected constants of the base model. */
interface CorrectedConstants {
  /** What they bring. */
  sentence: string;
  /** Why there are no intervals; `null` if there are. */
  withheld: string | null;
  /** Those that differ from the declared ones. */
  moved: ShownConstant[];
  /** Changes of the flow curves. */
  curves: CurveChange[];
}

/** Change of a flow curve, as shares of the declared flow. */
interface CurveChange {
  /** Table of the valve. */
  valve: string;
  /** Smallest change. */
  low: number;
  /** Largest change. */
  high: number;
}

/** The description of a machine. */
interface Described {
  /** What runs the controller: `host`, `ecu` or `bus`. */
  source: string;
  /** Whether the page may write a calibration to it. */
  may_write: boolean;
  /** Angle at which the hitches begin, degree. */
  angle_deg: number;
  /** Ends of the swing, degree. */
  swing_deg: [number, number];
  /** Range of loads, kg. */
  loads_kg: [number, number];
  /** Range of oil temperatures, C. */
  oils_c: [number, number];
  /** Longest advance, ms. */
  longest_ms: number;
  /** The linkage. */
  linkage: DrawnLinkage;
  /** Whether both calibrations are equal. */
  equal: boolean;
  /** Maps of the first and of the rebuilt calibration. */
  maps: [ValveMaps, ValveMaps];
  /** Tractor and field, if the hitches can work on one. */
  field: DescribedField | null;
  /** Why they cannot. */
  no_field: string | null;
}

/** Tractor and implement of the work on a field, and the ranges of its controls. */
interface DescribedField {
  /** Rocker angle at which the share touches level ground, degree. */
  touch_deg: number;
  /** Rocker angle of the raised implement, degree. */
  raised_deg: number;
  /** Rocker angle at which it works at its usual depth, degree. */
  working_deg: number;
  /** Distance of the axles, m. */
  wheelbase_m: number;
  /** Radius of the rear wheels, m. */
  rear_radius_m: number;
  /** Middle of the shares behind the rear axle, m. */
  share_m: number;
  /** Length of the share line, m. */
  share_line_m: number;
  /** Range of ground speeds, m/s. */
  speeds_m_s: [number, number];
  /** Range of set points of the draft, N. */
  drafts_n: [number, number];
  /** Range of set points of the depth, m. */
  depths_m: [number, number];
  /** Range of slip limits, 1. */
  slip_limits: [number, number];
}

/** The ground about the tractor, at points of equal distance. */
interface DrawnGround {
  /** The first point, in front of the rear axle, m. */
  from_m: number;
  /** Distance of the points, m. */
  step_m: number;
  /** Heights, m. */
  height_m: number[];
  /** Textures: `coarse`, `medium` or `fine`. */
  texture: string[];
  /** Whether the ground is a soft patch. */
  soft: boolean[];
}

/** The linkage over its swing. */
interface DrawnLinkage {
  /** Names of the joints. */
  joints: [string, string, string, string, string, string];
  /** Stroke of the cylinder, m. */
  stroke_m: number;
  /** Positions at equally spaced angles. */
  positions: DrawnPosition[];
}

/** A position of the linkage. */
interface DrawnPosition {
  /** Rocker angle, degree. */
  angle_deg: number;
  /** Its joints, m; x to the rear, y up. */
  joints: [([number, number]), ([number, number]), ([number, number]), ([number, number]), ([number, number]), ([number, number])];
}

/** Texts of an effect. */
interface EffectTexts {
  /** Name with its form. */
  name: string;
  /** Id. */
  id: string;
  /** Title. */
  title: string;
  /** Equation. */
  equation: string;
  /** Conditions in which it is visible. */
  shows: string;
  /** Literature or own work. */
  source: string;
  /** Meanings of its parameters. */
  parameters: ParameterMeaning[];
}

/** A run to log. */
interface ExpectedRun {
  /** Its load, start, oil temperature and duration. */
  conditions: string;
  /** Its currents, and each channel as every model expects it. */
  plot: RowPlot;
}

/** What models expect of the runs of a proposed experiment. */
interface ExpectedRuns {
  /** The models, in the order of their lines. */
  models: ExpectingModel[];
  /** What the lines decide; `null` for a single model. */
  decides: string | null;
  /** The runs. */
  runs: ExpectedRun[];
}

/** A model that expects something of the runs. */
interface ExpectingModel {
  /** Name of its lines. */
  name: string;
  /** Title of the effect that it has, or that it is the present model. */
  title: string;
}

/** A step of an explanation; errors in sigma. */
interface ExplainedStep {
  /** Texts of its effect. */
  effect: EffectTexts;
  /** Its size in the present model, in the unit of the first parameter; `null` if the effect is new. */
  changed_from: number | null;
  /** Error before it. */
  error_before: number;
  /** Error with it. */
  error_after: number;
  /** Error with it on held-out runs; `null` if no run was held out. */
  held_out_after: number | null;
  /** Confidence that it is this effect, 0 to 1. */
  confidence: number;
  /** The confidence in words. */
  in_words: string;
  /** Effects that are indistinguishable from it on these data. */
  indistinguishable: string[];
  /** Its parameters. */
  parameters: Parameter[];
}

/** What is wrong, where, and how to correct it. */
interface Fault {
  /** The file that is its cause. */
  file?: string;
  /** Line in the file, from 1. */
  line?: number;
  /** Column in the line, or in a formula, in characters from 1. */
  column?: number;
  /** What is wrong. */
  what: string;
  /** A suggested correction. */
  hint?: string;
}

/** The present state of tractor and field. */
interface FieldNow {
  /** Draft, kN, positive against the direction of travel. */
  draft_kn: number;
  /** Force of the soil on the implement upwards, kN. */
  vertical_kn: number;
  /** Working depth, m; negative above ground. */
  depth_m: number;
  /** Slip of the rear wheels, 0 to 1. */
  slip: number;
  /** Ground speed, m/s. */
  ground_speed_m_s: number;
  /** Speed of the rear wheels, m/s. */
  wheel_speed_m_s: number;
  /** Distance of the rear axle, m. */
  distance_m: number;
  /** Rear and front axle above their height on level ground without an implement, m. */
  axles_m: [number, number];
  /** What determines the set point, in short; `null`: the lever, or quick lift. */
  reason: string | null;
  /** The same in words. */
  reason_text: string;
  /** Lost sensor of draft, depth or slip control, in words. */
  trouble_text: string | null;
  /** Whether the implement is in work; `null` if the controller does not know. */
  in_work: boolean | null;
  /** The ground about the tractor. */
  ground: DrawnGround;
}

/** Tractor and field since the last answer. */
interface FieldView {
  /** Draft, kN. */
  draft_kn: number[];
  /** Working depth, cm; negative above ground. */
  depth_cm: number[];
  /** Slip of the rear wheels, percent. */
  slip_percent: number[];
  /** The present state; `null` before the first step. */
  now: FieldNow | null;
}

/** A figure of both calibrations. */
interface FigureRow {
  /** Cells as text. */
  cells: string[];
  /** Whether its limit is met; `null` without one. */
  met: boolean | null;
}

/** Constants that were fitted. */
interface FittedConstants {
  /** Error of the declared model, sigma. */
  error_before: number;
  /** Error of the fitted model, sigma. */
  error_after: number;
  /** Headings of the table. */
  headings: string[];
  /** Its rows. */
  rows: FittedRow[];
  /** Constants that the campaign does not determine. */
  not_determined: string[];
  /** Constants at the end of their allowed deviation. */
  at_an_end: string[];
}

/** A fitted constant. */
interface FittedRow {
  /** Cells as text. */
  cells: string[];
  /** Whether it moved further than its tolerance. */
  beyond: boolean;
}

/** A place or a signal. */
interface FormulaElement {
  /** Its name in formulas. */
  name: string;
  /** Its unit. */
  unit: string;
  /** Its meaning. */
  meaning: string;
}

/** The elements of formulas. */
interface FormulaElements {
  /** Where a term acts. */
  places: FormulaElement[];
  /** What it can depend on. */
  signals: FormulaElement[];
  /** Functions, each with its meaning. */
  functions: string[];
}

/** A campaign with its logs. */
interface FoundCampaign {
  /** Its name. */
  campaign: string;
  /** Number of its runs. */
  runs: number;
}

/** Grouping of the samples. */
type Grouping = "regime" | "current" | "load" | "temperature" | "run";

/** A grouping of the rows, with its title. */
interface GroupingTitle {
  /** The grouping. */
  by: Grouping;
  /** Its title. */
  title: string;
}

/** Samples of a hitch since the last answer, and its present state; `null` for a sample that is missing. */
interface HitchView {
  /** Times of the samples, s. */
  time_s: number[];
  /** Rocker angle, degree. */
  angle_deg: (number | null)[];
  /** Rocker angle as its sensor shows it, degree. */
  shown_deg: (number | null)[];
  /** Current of the lift valve, A. */
  lift_a: (number | null)[];
  /** Current of the lowering valve, A. */
  lower_a: (number | null)[];
  /** Cylinder pressure, bar. */
  cylinder_bar: (number | null)[];
  /** Pump pressure, bar. */
  pump_bar: (number | null)[];
  /** State in short. */
  state: string;
  /** State as sentences. */
  state_text: string;
  /** Fault in short. */
  fault: string | null;
  /** Fault in words. */
  fault_text: string | null;
  /** What the safety envelope found. */
  trip_text: string | null;
  /** Figures of the last move. */
  move: MoveFigures | null;
  /** Tractor and field, of a hitch that works on one. */
  field?: FieldView;
}

/** Names of the lines of a run. */
interface LineNames {
  /** Of the first model. */
  first?: string;
  /** Of the model. */
  simulated?: string;
  /** Of the second model. */
  second?: string;
}

/** A run in the list of runs. */
interface ListedRun {
  /** Its file. */
  file: string;
  /** Load or port pressure, and oil temperature, as text. */
  conditions: string;
  /** Its error, sigma; `null` if nothing of it is compared. */
  error: number | null;
}

/** A cell of an error map. */
interface LocatedCell {
  /** Grouping of the samples. */
  by: Grouping;
  /** Name of the group. */
  part: string;
  /** Key of the channel. */
  channel: string;
  /** Root mean square in sigma. */
  error: number;
  /** Mean in sigma; positive where the measurement exceeds the model. */
  bias: number;
  /** Compared samples. */
  samples: number;
  /** The stretch with its largest error. */
  worst: LocatedWorstStretch | null;
}

/** A stretch of time of a run. */
interface LocatedChangedStretch {
  /** Index of the run. */
  run: number;
  /** The stretch. */
  stretch: ChangedStretch;
}

/** A stretch of time of a run. */
interface LocatedWorstStretch {
  /** Index of the run. */
  run: number;
  /** The stretch. */
  stretch: WorstStretch;
}

/** The hitches after an advance. */
interface LoopAnswer {
  /** Both hitches of the simulation, or the one of an ECU. */
  loops: HitchView[];
  /** Simulated time over computing time, of a simulation. */
  speed?: number;
  /** Whether an emulated ECU is behind real time. */
  behind?: boolean;
  /** The connection to an ECU on the bus. */
  bus?: Connection;
}

/** A column: a measured channel, with the error of the model. */
interface MeasuredChannel {
  /** Key. */
  key: string;
  /** Name for a reader. */
  title: string;
  /** Unit of its values. */
  unit: string;
  /** Error, sigma. */
  error: number;
  /** One sigma of the instrument, in the unit. */
  noise: number;
}

/** A message of a computation to its tab. */
type Message = { kind: "progress"; text: string; fraction: number | null; error: number | null } | { kind: "candidate"; candidate: ShownCandidate; fraction: number } | { kind: "done" } | { kind: "failed"; text: string };

/** The error map of a model; each cell with its worst second. */
interface ModelMap {
  /** Which model it is. */
  name: string;
  /** Groupings of the cells. */
  groupings: GroupingTitle[];
  /** The measured channels. */
  channels: MeasuredChannel[];
  /** The cells. */
  cells: LocatedCell[];
}

/** A constant that a fit moves. */
interface MovableConstant {
  /** Its name in a model file. */
  name: string;
  /** Its declared value with the unit, of currents the threshold; of a curve, that it is one. */
  declared: string;
  /** Its usual tolerance, as a user gives one. */
  usual: string;
}

/** Figures of a move. */
interface MoveFigures {
  /** Angle at the start, degree. */
  from_deg: number;
  /** Set point, degree. */
  to_deg: number;
  /** Largest overshoot of the set point since its last change, degree. */
  overshoot_deg: number;
  /** Angle minus set point at rest, degree; `None` while the hitch moves. */
  error_deg: number | null;
  /** Time from the last change of the set point until the angle stays within half a degree of it, s; `None` if it is not
   * there. */
  arrived_s: number | null;
}

/** A parameter with its interval. */
interface Parameter {
  /** Name. */
  name: string;
  /** What it is, in a few words. */
  meaning: string;
  /** Unit; empty for a pure number. */
  unit: string;
  /** Estimate, in the unit. */
  value: number;
  /** Lower end of the 95 % interval, in the unit; `null` if it is unknown. */
  low: number | null;
  /** Upper end of the 95 % interval, in the unit; `null` if it is unknown. */
  high: number | null;
  /** Whether the estimate is at an end of its allowed range and therefore not a measurement. */
  at_its_limit: boolean;
}

/** A parameter of an effect. */
interface ParameterMeaning {
  /** Name. */
  name: string;
  /** Meaning. */
  meaning: string;
}

/** A line of a row. */
interface PlotLine {
  /** Name. */
  name: string;
  /** Lines with the same key share an entry of the legend. */
  key: string;
  /** Name of its colour. */
  colour: string;
  /** Its dashes. */
  dash?: string;
  /** Its width, px. */
  width?: number;
  /** Its own abscissa. */
  x?: number[];
  /** Its values. */
  y: Samples;
}

/** A row of a plot. */
interface PlotRow {
  /** Title. */
  title: string;
  /** Unit of its values. */
  unit: string;
  /** Preferred height, px. */
  height?: number;
  /** Its lines. */
  lines: PlotLine[];
}

/** The proposed assignment of logs. */
interface ProposedCampaign {
  /** Name of the campaign. */
  name: string;
  /** The logs. */
  logs: ProposedLog[];
  /** Logs with equal columns. */
  groups: ProposedGroup[];
  /** The signals of a run. */
  signals: Signal[];
}

/** A column of a log. */
interface ProposedColumn {
  /** Its name. */
  name: string;
  /** The unit that the log states. */
  unit: string | null;
}

/** A proposed experiment. */
interface ProposedExperiment {
  /** Manoeuvre and purpose, as a sentence without a full stop. */
  sentence: string;
  /** Whether there are runs to log. */
  has_runs: boolean;
}

/** Logs with equal columns. */
interface ProposedGroup {
  /** Their files. */
  files: string[];
  /** Whether they have a column of times. */
  times: boolean;
  /** Whether their columns have units of their own. */
  own_units: boolean;
  /** Their columns. */
  columns: ProposedColumn[];
  /** The columns that are taken. */
  taken: TakenColumn[];
  /** What was assumed, and columns of a signal that are left out with the reason. */
  notes: string[];
  /** The other columns that are not used. */
  unused: string[];
  /** What could not be determined. */
  untold: string | null;
}

/** A log. */
interface ProposedLog {
  /** Its file. */
  file: string;
  /** The load in its name, kg. */
  load_kg: number | null;
}

/** A question, with the value of the first model. */
interface Question {
  /** Name of the constant. */
  name: string;
  /** The question. */
  question: string;
  /** The value, as in a model file. */
  value: string;
}

/** A plot with rows of its own. */
interface RowPlot {
  /** Title of the abscissa, with its unit. */
  x_title: string;
  /** Ends of the abscissa. */
  span: [number, number];
  /** The common abscissa. */
  time_s: number[];
  /** The rows. */
  rows: PlotRow[];
}

/** A channel of a run: samples in its unit, residuals and errors in sigma. */
interface RunChannel {
  /** Key. */
  key: string;
  /** Name for a reader. */
  title: string;
  /** Unit of the samples. */
  unit: string;
  /** Error of the model. */
  error: number;
  /** Measured. */
  measured: Samples;
  /** Simulated by the model. */
  simulated: Samples;
  /** Residuals of the model. */
  residual: Samples;
  /** Simulated by the first model, if it is another one. */
  first: Samples | null;
  /** Residuals of the first model. */
  first_residual?: Samples;
  /** The second model. */
  second: SimulatedChannel | null;
}

/** A run. */
interface RunView {
  /** Its index. */
  run: number;
  /** Its file. */
  file: string;
  /** Load or port pressure, and oil temperature, as text. */
  conditions: string;
  /** Names of the lines, where they are not the usual ones. */
  names: LineNames | null;
  /** Time stamps, s. */
  time_s: number[];
  /** Current of the lift valve, A. */
  lift_current_a: Samples;
  /** Current of the lowering valve, A. */
  lower_current_a: Samples;
  /** The measured channels. */
  channels: RunChannel[];
}

/** Samples of a signal, in its unit; `null` where there is none. */
type Samples = (number | null)[];

/** Both models by channel and cell; errors in sigma. */
interface SecondModel {
  /** Title of the second model. */
  title: string;
  /** Its name. */
  model: string;
  /** Index of the step that it is; `null` if it is another one. */
  step: number | null;
  /** Whether changes are those from the present model to it. */
  is_after: boolean;
  /** Whether it is the present model. */
  is_present: boolean;
  /** Whether its linkage is another one. */
  has_other_linkage: boolean;
  /** Error of the model before. */
  before: number;
  /** Error of the model after. */
  after: number;
  /** The measured channels. */
  channels: ChangedChannel[];
  /** The cells of both models. */
  changes: CellChange[];
  /** The error map of the second model. */
  cells: Cell[];
}

/** The questions of data sheets. */
interface Sheet {
  /** The questions in their order. */
  questions: Question[];
}

/** An effect that may be missing. Its confidence is known only when all are evaluated. */
interface ShownCandidate {
  /** Its texts. */
  effect: EffectTexts;
  /** Share of the squared error above the noise that it explains, 0 to 1. */
  explains: number;
  /** Error with it, sigma. */
  error_after: number;
  /** Confidence that it is this effect, 0 to 1. */
  confidence?: number;
  /** The confidence in words. */
  in_words?: string;
  /** Effects that are indistinguishable from it on these data. */
  indistinguishable?: string[];
  /** Its parameters. */
  parameters: Parameter[];
}

/** A constant. */
interface ShownConstant {
  /** Name in a model file. */
  name: string;
  /** Unit of the values. */
  unit: string;
  /** Declared value, in the unit. */
  declared: number;
  /** Fitted value, in the unit. */
  fitted: number;
  /** Tolerance of the declared value before the fit: one sigma, in the unit. */
  tolerance: number;
  /** Lower end of the 95 % interval, in the unit; `null` if it is unknown. */
  low: number | null;
  /** Upper end of the 95 % interval, in the unit; `null` if it is unknown. */
  high: number | null;
  /** Whether the campaign determines it. */
  determined: boolean;
}

/** An effect of the present model. */
interface ShownEffect {
  /** Its texts. */
  effect: EffectTexts;
  /** Its parameters. */
  parameters: ShownParameter[];
}

/** An explanation that starts from the present model; errors in sigma. */
interface ShownExplanation {
  /** Error of the model that it starts from: the present one, with constants in the middle of their ranges. */
  error_before: number;
  /** Error with all steps. */
  error_after: number;
  /** Verdict. */
  verdict: string;
  /** What the verdict means. */
  meaning: string;
  /** Corrected constants of the base model. */
  constants: CorrectedConstants | null;
  /** The effects added or changed, in order. */
  steps: ExplainedStep[];
  /** Whether the search ended, at its limit or cancelled, before its result was stable. */
  unfinished: boolean;
  /** Why effects that reduce the error are not named, a sentence each. */
  doubtful: string[];
  /** A term for the remaining error. */
  suggested: Suggested | null;
  /** Ids of effects that are not detectable in the campaign. */
  not_visible: string[];
  /** The most informative next experiment, if one is needed. */
  next: ProposedExperiment | null;
}

/** A parameter with the range of its slider; values in its unit. */
interface ShownParameter {
  /** Whether it keeps its value in fits. */
  fixed: boolean;
  /** Name. */
  name: string;
  /** Unit; empty for a pure number. */
  unit: string;
  /** Meaning. */
  meaning: string;
  /** Value. */
  value: number;
  /** Lower end of the range; `null` without one. */
  low: number | null;
  /** Upper end of the range; `null` without one. */
  high: number | null;
  /** Size of a typical change. */
  scale: number;
  /** Whether changes are relative to its value. */
  by_magnitude: boolean;
}

/** A ranking of the effects that the present model may lack. */
interface ShownRanking {
  /** Error of the present model, sigma. */
  error_before: number;
  /** The candidates, best first. */
  candidates: ShownCandidate[];
  /** The experiment that separates the best ones. */
  next: ProposedExperiment | null;
  /** A hint that the declared constants may be off. */
  constants_hint: string | null;
}

/** A step of a session. */
interface ShownStep {
  /** Its title. */
  title: string;
  /** Error, sigma. */
  error: number;
  /** Error on held-out runs, sigma; `null` without a fit. */
  held_out: number | null;
}

/** A signal of a run. */
interface Signal {
  /** Key. */
  key: string;
  /** Name for a reader. */
  title: string;
  /** Its unit. */
  unit: string;
  /** Units that convert to it. */
  units: string[];
  /** Units of a sensor, with which two points have to be known. */
  raw: string[];
}

/** The part of the residuals of a channel that a candidate explains. */
interface Signature {
  /** Residual without it minus residual with it, sigma. */
  signature: Samples;
}

/** Parts of the measured channels of a run. */
interface Signatures {
  /** Index of the run. */
  run: number;
  /** A part of each channel. */
  channels: Signature[];
}

/** A channel as a model simulates it. */
interface SimulatedChannel {
  /** Samples, in the unit of the channel. */
  simulated: Samples;
  /** Residuals, sigma. */
  residual: Samples;
  /** Error, sigma. */
  error: number;
}

/** Parts of the measured channels of a run. */
interface SimulatedChannels {
  /** Index of the run. */
  run: number;
  /** A part of each channel. */
  channels: SimulatedChannel[];
}

/** State of a tab. */
interface State {
  /** Name of the campaign. */
  campaign: string;
  /** What it is about. */
  description: string;
  /** Name and kind of the first model. */
  model: string;
  /** Name of the first model before it; `null` if there is none. */
  earlier_model: string | null;
  /** The steps from data to a saved calibration. */
  way: WayStep[];
  /** Constants that a fit moves, and their fit. */
  constants: Constants;
  /** The tuned calibration of the present model. */
  tuned: TunedCalibration | null;
  /** What the terms of results mean. */
  words: Word[];
  /** The runs. */
  runs: ListedRun[];
  /** The measured channels. */
  channels: MeasuredChannel[];
  /** Error of all channels, sigma. */
  error: number;
  /** Error of a perfect model, sigma. */
  noise_floor: number;
  /** Groupings of the error map. */
  groupings: GroupingTitle[];
  /** The second model, compared with the present one. */
  second: SecondModel | null;
  /** The error map. */
  cells: Cell[];
  /** All steps, with undone ones. */
  steps: ShownStep[];
  /** Index of the present step. */
  at: number;
  /** The effects of the present model. */
  effects: ShownEffect[];
  /** The ranking, if it belongs to the present model. */
  ranking: ShownRanking | null;
  /** The explanation, if it starts from the present model. */
  explained: ShownExplanation | null;
  /** Title of the running computation. */
  job: string | null;
}

/** A suggested term: a candidate for a model file, not an identified cause. */
interface Suggested {
  /** Where it acts. */
  place: string;
  /** Its formula. */
  formula: string;
  /** Its parameters. */
  parameters: Parameter[];
  /** Error without it, on held-out runs, in sigma; `null` if no run was held out. */
  held_out_before: number | null;
  /** Error with it, on held-out runs, in sigma; `null` if no run was held out. */
  held_out_after: number | null;
  /** Error with it, in sigma. */
  error_after: number;
  /** Steps that are redundant beside it. */
  replaces: string[];
  /** The term as it is written into a model file. */
  model_file: string;
}

/** What the files of an upload are. */
type Surveyed = FoundCampaign | ProposedCampaign;

/** A column that is taken for a signal. */
interface TakenColumn {
  /** Key of the signal. */
  channel: string;
  /** Name of the column. */
  column: string;
  /** Its unit; `null` if the log states it. */
  unit: string | null;
  /** The reason. */
  reason: string;
  /** Whether name or unit is an assumption. */
  assumed: boolean;
}

/** A table that was taken. */
interface TakenTable {
  /** Its points and ranges, in words. */
  said: string;
}

/** Errors of all runs with a parameter set by hand, sigma. */
interface TriedRuns {
  /** Of all channels. */
  error: number;
  /** By channel. */
  channels: MeasuredChannel[];
  /** By run. */
  runs: Samples;
  /** By cell. */
  cells: Cell[];
}

/** A tuned calibration: its figures and its changed values. */
interface TunedCalibration {
  /** How many limits are met; `null` without limits. */
  sentence: string | null;
  /** Headings of the table of figures. */
  headings: string[];
  /** The figures. */
  figures: FigureRow[];
  /** The changed values. */
  changes: Change[];
}

/** Flow over current of a valve, up to its largest current. */
interface ValveMap {
  /** Currents, A. */
  current_a: number[];
  /** Flows, l/min. */
  flow_lpm: number[];
  /** Current at which it opens, A. */
  threshold_a: number;
  /** Largest flow, l/min. */
  saturation_lpm: number;
}

/** Maps of both valves. */
interface ValveMaps {
  /** Of the lift valve. */
  lift: ValveMap;
  /** Of the lowering valve. */
  lower: ValveMap;
}

/** A step of the way. */
interface WayStep {
  /** Key. */
  key: string;
  /** Title. */
  title: string;
  /** The tab where it is made. */
  tab: string;
  /** Whether it is done. */
  done: boolean;
  /** Its state in a few words. */
  state: string;
}

/** A term and what it means. */
interface Word {
  /** The term as it is written beside a figure. */
  term: string;
  /** Its meaning, a phrase without a full stop. */
  means: string;
}

/** The stretch of time in which a channel has its largest error. */
interface WorstStretch {
  /** Key of the channel. */
  channel: string;
  /** File of the run. */
  run: string;
  /** Start, s. */
  from_s: number;
  /** End, s. */
  to_s: number;
  /** Root mean square in sigma. */
  error: number;
}
