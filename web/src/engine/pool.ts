// Engines beside that of the motion, one for each core. They are made when they are needed first.
import { Engine } from "./engine";

const most_engines = 16;

export class EnginePool {
  private readonly idle: Engine[] = [];
  private readonly waiting: ((engine: Engine) => void)[] = [];
  private count = 0;
  readonly most = Math.min(navigator.hardwareConcurrency || 1, most_engines);

  /// Runs a task with an engine that no other task has meanwhile.
  async run<Result>(task: (engine: Engine) => Promise<Result>): Promise<Result> {
    const engine = this.idle.pop() ?? (this.count < this.most ? this.another() : await new Promise<Engine>((resolve) => this.waiting.push(resolve)));
    try {
      return await task(engine);
    } finally {
      const next = this.waiting.shift();
      if (next === undefined) this.idle.push(engine);
      else next(engine);
    }
  }

  private another(): Engine {
    ++this.count;
    return new Engine();
  }
}
