// The engine as the page sees it: a worker whose functions return promises.
import worker_source from "worker-source";
import { address_of_rest, first_part, rest_part } from "./data";
import type { CallName, Calls, Complaint, Part, Question, Reply } from "./protocol";

/// The reader's messages, or one of the engine.
export class EngineError extends Error {
  constructor(readonly complaints: Complaint[]) {
    super(complaints.map((each) => (each.key ? `${each.key}: ` : "") + each.message).join("\n"));
  }
}

export interface Answer<Name extends CallName> {
  value: Calls[Name]["answer"];
  rows: Float64Array;
  points: Float64Array;
}

const pause = 300; // ms from the first steps to loading the rest, so that the first pictures are drawn before

export class Engine {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, (response: Reply) => void>();
  private next_id = 0;
  private readonly ready: Promise<void>;
  private is_at_first = false; // the scenario is the one that the first part suffices for
  private has_advanced = false;
  has_rest = false;

  /// @param first_scenario the one with which web/split.mjs has found the first part
  constructor(private readonly first_scenario = "") {
    this.worker = new Worker(URL.createObjectURL(new Blob([worker_source], { type: "text/javascript" })));
    this.worker.onmessage = (event: MessageEvent<Reply>) => {
      const resolve = this.waiting.get(event.data.id);
      this.waiting.delete(event.data.id);
      resolve?.(event.data);
    };
    this.ready = Promise.all([first_part(), address_of_rest()]).then(([first, address]) => this.post({ first, rest_address: address }));
  }

  async call<Name extends CallName>(call: Name, motion = 0, ...args: Calls[Name]["args"]): Promise<Answer<Name>> {
    if (!this.has_rest && !this.first_suffices(call, args)) await this.add_rest();
    await this.ready;
    const request: Question = { id: this.next_id++, call, motion, args };
    const response = await new Promise<Reply>((resolve) => {
      this.waiting.set(request.id, resolve);
      this.post(request);
    });
    if (call === "advance" && !this.has_advanced) {
      this.has_advanced = true;
      setTimeout(() => void this.add_rest().catch(() => {}), pause); // a call that needs the rest tries again, and reports it
    }
    const value = JSON.parse(response.json) as Calls[Name]["answer"] & { errors?: Complaint[] };
    if (value.errors !== undefined) throw new EngineError(value.errors);
    return { value, rows: response.rows ?? new Float64Array(), points: response.points ?? new Float64Array() };
  }

  /// What web/split.mjs has asked, too.
  private first_suffices(call: CallName, args: (string | number)[]): boolean {
    if (call === "open") this.is_at_first = args[0] === this.first_scenario;
    return call === "declarations" || (this.is_at_first && (["open", "state", "advance"].includes(call) || (call === "show" && args[0] === "")));
  }
  private async add_rest(): Promise<void> {
    const module = await rest_part();
    if (this.has_rest) return;
    this.has_rest = true;
    this.post({ rest: module });
  }
  private post(message: Part | Question): void {
    this.worker.postMessage(message);
  }
}
