// The engine as the page sees it: a worker whose functions return promises.
import worker_source from "worker-source";
import type { CallName, Calls, Complaint, Question, Reply } from "./protocol";

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

/// The bytes of a file: inside this page, compressed (laboratory.html), or beside it.
export async function asset_bytes(id: string, file: string): Promise<ArrayBuffer> {
  const inlined = document.getElementById(id);
  if (inlined === null) return (await fetch(file)).arrayBuffer();
  const packed = await fetch(`data:application/octet-stream;base64,${inlined.textContent!.trim()}`);
  return new Response(packed.body!.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

let compiled: Promise<WebAssembly.Module> | undefined;

export class Engine {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, (response: Reply) => void>();
  private next_id = 0;
  private readonly ready: Promise<void>;

  constructor() {
    this.worker = new Worker(URL.createObjectURL(new Blob([worker_source], { type: "text/javascript" })));
    this.worker.onmessage = (event: MessageEvent<Reply>) => {
      const resolve = this.waiting.get(event.data.id);
      this.waiting.delete(event.data.id);
      resolve?.(event.data);
    };
    compiled ??= asset_bytes("engine", "engine.wasm").then((bytes) => WebAssembly.compile(bytes));
    this.ready = compiled.then((module) => this.worker.postMessage(module));
  }

  async call<Name extends CallName>(call: Name, motion = 0, ...args: Calls[Name]["args"]): Promise<Answer<Name>> {
    await this.ready;
    const request: Question = { id: this.next_id++, call, motion, args };
    const response = await new Promise<Reply>((resolve) => {
      this.waiting.set(request.id, resolve);
      this.worker.postMessage(request);
    });
    const value = JSON.parse(response.json) as Calls[Name]["answer"] & { errors?: Complaint[] };
    if (value.errors !== undefined) throw new EngineError(value.errors);
    return { value, rows: response.rows ?? new Float64Array(), points: response.points ?? new Float64Array() };
  }
}
