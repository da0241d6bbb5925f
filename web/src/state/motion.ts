// A motion: a scenario that the engine integrates, its columns, and the rows so far.
import { Engine } from "../engine/engine";
import type { Certificate, Facts, MotionState, Returned } from "../engine/protocol";
import { Recording } from "./recording";

export class Motion {
  facts!: Facts;
  state!: MotionState;
  recording!: Recording;
  points: number[] = []; // of the section: t, q and p each
  private usual: string[] = []; // the columns of every motion of these coordinates
  private all: string[] = []; // with the expressions

  constructor(private readonly engine: Engine, private readonly number: number) {}

  /// @throws EngineError with the reader's messages; then the motion before goes on
  async open(toml: string): Promise<void> {
    this.facts = (await this.engine.call("open", this.number, toml, "")).value;
    this.usual = ["t", ...this.facts.q, ...this.facts.p, "energy error"];
    this.points = [];
    await this.show([]);
    this.state = (await this.engine.call("state", this.number)).value;
  }

  /// Adds columns to the rows, and begins a new recording.
  /// @param columns names of observables, or expressions; others are there already
  async show(columns: string[]): Promise<void> {
    const wanted = columns.filter((each) => each !== "" && !this.names().includes(each));
    const expressions = wanted.map((each) => this.facts.observables.find(({ name }) => name === each)?.expression ?? each);
    const shown = await this.engine.call("show", this.number, expressions.join("\n"));
    this.all = [...this.usual, ...wanted];
    this.recording = new Recording(shown.value.width);
    this.recording.append(shown.rows);
  }

  async advance(steps: number, every: number): Promise<void> {
    const answer = await this.engine.call("advance", this.number, steps, every);
    this.state = answer.value;
    this.recording.append(answer.rows);
    for (const x of answer.points) this.points.push(x);
  }

  async reverse(): Promise<void> {
    this.state = (await this.engine.call("reverse", this.number)).value;
  }
  async returned(): Promise<Returned> {
    return (await this.engine.call("returned", this.number)).value;
  }
  async certificate(): Promise<Certificate> {
    return (await this.engine.call("certificate", this.number)).value;
  }

  /// The names of the columns of every motion.
  names(): string[] {
    return this.usual;
  }
  columns(): string[] {
    return this.all;
  }
  /// -1: there is no such column.
  column(name: string): number {
    return this.columns().indexOf(name);
  }
  get energy_column(): number {
    return 1 + 2 * this.facts.q.length;
  }
}
