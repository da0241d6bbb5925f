// What the page has inside: the engine and the HDF5 library, compressed, and the rows that `hamflow view` has put there.
import worker_source from "data-worker-source";
import type { DataQuestion, DataReply } from "./data_worker";

let worker: Worker | undefined;
const waiting = new Map<number, (reply: DataReply) => void>();
let next_id = 0;

export function decoded(kind: DataQuestion["kind"], text: string): Promise<DataReply> {
  if (worker === undefined) {
    worker = new Worker(URL.createObjectURL(new Blob([worker_source], { type: "text/javascript" })));
    worker.onmessage = ({ data }: MessageEvent<DataReply>) => {
      waiting.get(data.id)?.(data);
      waiting.delete(data.id);
    };
  }
  const question: DataQuestion = { id: next_id++, kind, text };
  return new Promise((resolve, reject) => {
    waiting.set(question.id, (reply) => (reply.error === undefined ? resolve(reply) : reject(new Error(`what this page has inside is damaged: ${reply.error}`))));
    worker!.postMessage(question);
  });
}

/// The bytes of a file: inside this page (laboratory.html), or beside it.
export async function asset_bytes(id: string, file: string): Promise<ArrayBuffer> {
  const inside = document.getElementById(id);
  if (inside !== null) return (await decoded("bytes", inside.textContent!)).bytes;
  return (await fetched(file)).arrayBuffer();
}
async function fetched(address: string): Promise<Response> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status} ${response.statusText}`);
  return response;
}

/// A promise that is made when it is asked for first, and again if it has failed.
function once<T>(make: () => Promise<T>): () => Promise<T> {
  let made: Promise<T> | undefined;
  return () => (made ??= make().catch((error: unknown) => {
    made = undefined;
    throw error;
  }));
}

/// What the first picture needs of the engine (web/split.mjs), compiled. Inside this page it is compiled while it is decompressed.
export const first_part = once(async () => {
  const inside = document.getElementById("engine");
  if (inside === null) return WebAssembly.compile(await asset_bytes("engine", "engine.wasm"));
  return (await decoded("module", inside.textContent!)).module!;
});
/// Where a worker finds the rest. It can wait for an address, but not for the page to unpack the bytes.
export const address_of_rest = once(async () => {
  if (document.getElementById("engine-rest") === null) return new URL("engine-rest.wasm", document.baseURI).href;
  return URL.createObjectURL(new Blob([await asset_bytes("engine-rest", "engine-rest.wasm")]));
});
export const rest_part = once(async () => WebAssembly.compile(await (await fetched(await address_of_rest())).arrayBuffer()));
